#include "server/campaign/folder.h"

#include <fstream>
#include <functional>

#include "server/campaign/summary_json.h"
#include "server/report/campaign_report.h"

namespace stagger::server::campaign {
namespace {

namespace fs = std::filesystem;

void write_whole(const fs::path& file, const std::function<void(std::ostream&)>& write) {
  const fs::path unfinished = file.string() + ".part";
  {
    std::ofstream out(unfinished, std::ios::binary);
    write(out);
    out.close();
    if (!out) throw std::runtime_error("cannot write " + file.string());
  }
  fs::rename(unfinished, file);
}

void make_folder(const fs::path& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (error) throw std::runtime_error("cannot make " + path.string() + ": " + error.message());
}

}  // namespace

void Folder::create(const std::string& specification, Store::Journal journal) const {
  if (holds_campaign()) {
    throw std::runtime_error(path_.string() + " holds a campaign already: go on with `stagger " +
                             "campaign resume " + path_.string() + "`, or choose another --out");
  }
  make_folder(path_);
  // A process that is killed while it makes the store leaves none.
  const fs::path unfinished = store().string() + ".part";
  std::error_code error;
  fs::remove(unfinished, error);
  Store::create(unfinished, specification, journal);
  fs::rename(unfinished, store());
}

void Folder::write(OutputFile file, std::ostream& out, const Plan& plan, const Store& store,
                   const Summary& summary) const {
  switch (file) {
    case OutputFile::summary:
      out << summary_json(plan, store, summary).dump(2, ' ', false, Json::error_handler_t::replace)
          << '\n';
      break;
    case OutputFile::csv:
      write_csv(out, plan, store);
      break;
    case OutputFile::ndjson:
      write_ndjson(out, plan, store);
      break;
    case OutputFile::junit:
      write_junit(out, plan, summary);
      break;
    case OutputFile::report:
      fs::path whole = fs::absolute(path_).lexically_normal();
      if (!whole.has_filename()) whole = whole.parent_path();
      out << campaign_report(plan, store, summary, whole.filename().string());
      break;
  }
}

void Folder::write_files(const Plan& plan, const Store& store, const Summary& summary) const {
  for (const OutputFile file : output_files) {
    write_whole(path_of(file), [&](std::ostream& out) { write(file, out, plan, store, summary); });
  }
}

void Folder::remove_files() const {
  for (const OutputFile file : output_files) fs::remove(path_of(file));
}

fs::path Folder::write_report(const Plan& plan, const Store& store, const Summary& summary) const {
  const fs::path file = path_of(OutputFile::report);
  write_whole(file,
              [&](std::ostream& out) { write(OutputFile::report, out, plan, store, summary); });
  return file;
}

std::vector<fs::path> write_figures(const fs::path& folder, const Plan& plan, const Store& store,
                                    const Summary& summary) {
  make_folder(folder);
  std::vector<fs::path> files;
  for (const FigureFile& figure : campaign_figures(plan, store, summary)) {
    files.push_back(folder / figure.name);
    write_whole(files.back(), [&](std::ostream& out) { out << figure.svg; });
  }
  return files;
}

// Not the store itself: SQLite has locks of its own on it.
FolderLock::FolderLock(const Folder& folder)
    : lock_(FileLock::take(folder.path() / "campaign.lock")) {
  if (lock_) return;
  throw std::runtime_error(folder.path().string() + ": another process runs this campaign");
}

}  // namespace stagger::server::campaign
