#include "server/http/static_files.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "server/http/problem.h"

namespace stagger::server {
namespace {

namespace fs = std::filesystem;

class StaticFiles : public ::testing::Test {
 protected:
  StaticFiles() {
    fs::create_directories(root_ / "dist/assets");
    write("secret.txt", "secret");
    write("dist/index.html", "<p>page</p>");
    write("dist/assets/app-1a2b.js", "run()");
    fs::create_symlink(root_ / "secret.txt", root_ / "dist/link.txt");
  }
  ~StaticFiles() override { fs::remove_all(root_); }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(root_ / name) << text;
  }
  fs::path dist() const { return root_ / "dist"; }
  std::string cache(const std::string& path) const {
    for (const auto& [name, value] : dashboard_response(dist(), path).headers) {
      if (name == "Cache-Control") return value;
    }
    return "";
  }

 private:
  fs::path root_ =
      fs::temp_directory_path() / ("stagger_static_" + std::to_string(getpid()) + "_" +
                                   ::testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST_F(StaticFiles, FindsFilesBelowTheFolder) {
  EXPECT_TRUE(file_below(dist(), "/index.html"));
  EXPECT_TRUE(file_below(dist(), "assets/../index.html"));
  EXPECT_FALSE(file_below(dist(), "/assets"));
  EXPECT_FALSE(file_below(dist(), "/nothing.js"));
  EXPECT_FALSE(file_below(dist() / "nowhere", "/index.html"));
}

TEST_F(StaticFiles, NeverLeavesTheFolder) {
  EXPECT_FALSE(file_below(dist(), "/../secret.txt"));
  EXPECT_FALSE(file_below(dist(), "../../../../../../etc/passwd"));
  EXPECT_FALSE(file_below(dist(), "//etc/passwd"));
  EXPECT_FALSE(file_below(dist(), "/link.txt"));
  EXPECT_FALSE(file_below(dist(), std::string("/index.html\0.js", 15)));
}

TEST_F(StaticFiles, OnlyHashedFilesMayBeKept) {
  EXPECT_EQ(cache("/"), "no-cache");
  EXPECT_EQ(cache("/index.html"), "no-cache");
  EXPECT_EQ(cache("/assets/app-1a2b.js"), "public, max-age=31536000, immutable");
}

TEST_F(StaticFiles, NamesTheType) {
  EXPECT_EQ(dashboard_response(dist(), "/").content_type, "text/html; charset=utf-8");
  EXPECT_EQ(dashboard_response(dist(), "/assets/app-1a2b.js").content_type,
            "text/javascript; charset=utf-8");
}

TEST_F(StaticFiles, SaysHowToBuildADashboardThatIsMissing) {
  const HttpResponse page = dashboard_response(dist() / "nowhere", "/");
  EXPECT_EQ(page.status, 200);
  EXPECT_NE(page.body.find("npm run build"), std::string::npos);
  EXPECT_THROW(dashboard_response(dist(), "/nothing.js"), Problem);
}

}  // namespace
}  // namespace stagger::server
