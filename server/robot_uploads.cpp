#include "server/robot_uploads.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <chrono>
#include <cstdlib>
#include <fstream>

#include "server/child_process.h"
#include "server/http/message.h"
#include "server/live/ticket.h"
#include "sim/json_file.h"
#include "sim/robot/mesh_file.h"

namespace stagger::server {
namespace {

namespace fs = std::filesystem;

using namespace std::chrono_literals;

constexpr auto turn_patience = 10s;
constexpr auto check_patience = 60s;
constexpr auto leftover_age = std::chrono::hours(1);
constexpr std::size_t most_name = 64;
constexpr std::size_t most_path_parts = 8;
constexpr std::size_t most_told = 2000;  // bytes of what went wrong

constexpr std::array mesh_extensions{".stl", ".obj", ".dae", ".mtl", ".png", ".jpg", ".jpeg"};

bool is_name(const std::string& name) {
  const auto fits = [](unsigned char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  };
  return !name.empty() && name.size() <= most_name && name[0] != '_' && name[0] != '-' &&
         std::all_of(name.begin(), name.end(), fits);
}

void check_name(const std::string& name) {
  if (is_name(name)) return;
  throw RobotRefused("name", "is \"" + name.substr(0, most_name) +
                                 "\"; allowed: 1 to 64 of a-z, 0-9, _ and -, a letter or digit "
                                 "first");
}

/// A path that stays below the folder on any system.
bool is_path(const std::string& path) {
  const auto fits = [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '-' || c == '.' || c == '+' || c == ' ';
  };
  std::size_t parts = 0;
  std::size_t start = 0;
  while (start <= path.size()) {
    const std::size_t end = std::min(path.find('/', start), path.size());
    const std::string part = path.substr(start, end - start);
    if (part.empty() || part[0] == '.' || part.size() > most_name || ++parts > most_path_parts ||
        !std::all_of(part.begin(), part.end(), fits)) {
      return false;
    }
    start = end + 1;
  }
  return true;
}

void check_mesh(const std::string& path) {
  const std::string extension = lower(fs::path(path).extension().string());
  const bool known =
      std::find(mesh_extensions.begin(), mesh_extensions.end(), extension) != mesh_extensions.end();
  if (known && is_path(path)) return;
  throw RobotRefused("mesh", "the file name \"" + path.substr(0, 200) +
                                 "\" is not taken; allowed: the path as the URDF says it, without "
                                 "package:// and .., of letters, digits and . _ - +, ending in "
                                 ".stl, .obj, .dae, .mtl, .png or .jpg");
}

void write_file(const fs::path& file, const std::string& content) {
  fs::create_directories(file.parent_path());
  std::ofstream out(file, std::ios::binary);
  out << content;
  out.close();
  if (!out) {
    throw CommandError(CommandError::Kind::failed, "the data folder cannot be written to");
  }
}

/// The description, made to speak of the file that the URDF is kept as.
std::string kept_description(const std::string& text) {
  nlohmann::json description;
  try {
    description = sim::parse_json(text);
  } catch (const sim::JsonSyntaxError& error) {
    throw RobotRefused("description", "is not JSON: line " + std::to_string(error.line) +
                                          ", column " + std::to_string(error.column) + ": " +
                                          error.what());
  }
  if (!description.is_object()) throw RobotRefused("description", "is no JSON object");
  description["urdf"] = "robot.urdf";
  return description.dump(2) + "\n";
}

/// What the check wrote to standard error, without its frame.
std::string told(std::string text) {
  for (const char* frame : {"stagger: ", "robot.urdf: ", "cannot walk: "}) {
    if (text.starts_with(frame)) text.erase(0, std::string(frame).size());
  }
  while (!text.empty() && text.back() == '\n') text.pop_back();
  text.resize(std::min(text.size(), most_told));
  return text.empty() ? "cannot be read" : text;
}

/// By the clock of the day: the thread sanitizer of GCC 12 follows no lock by another.
std::chrono::system_clock::time_point turn_deadline() {
  return std::chrono::system_clock::now() + turn_patience;
}

}  // namespace

/// A folder of its own while a robot is looked into.
class RobotUploads::Workplace {
 public:
  explicit Workplace(const fs::path& data) {
    const fs::path incoming = data / "incoming";
    try {
      fs::create_directories(incoming);
    } catch (const fs::filesystem_error&) {
      throw CommandError(CommandError::Kind::failed, "the data folder cannot be written to");
    }
    remove_leftovers(incoming);
    std::string pattern = fs::absolute(incoming / "robot-XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr) {
      throw CommandError(CommandError::Kind::failed, "the data folder cannot be written to");
    }
    folder_ = pattern;
  }
  ~Workplace() {
    std::error_code ignored;  // a destructor may not throw
    fs::remove_all(folder_, ignored);
  }
  Workplace(const Workplace&) = delete;
  Workplace& operator=(const Workplace&) = delete;

  const fs::path& folder() const { return folder_; }

 private:
  /// Of a server that was killed at work.
  static void remove_leftovers(const fs::path& incoming) {
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(incoming, ignored)) {
      const auto written = entry.last_write_time(ignored);
      if (ignored || fs::file_time_type::clock::now() - written < leftover_age) continue;
      fs::remove_all(entry.path(), ignored);
    }
  }

  fs::path folder_;
};

RobotUploads::RobotUploads(RobotLibrary& library, fs::path data, fs::path program)
    : library_(library), data_(std::move(data)), program_(std::move(program)) {}

Json RobotUploads::check(const RobotUpload& upload) {
  const std::unique_lock lock(mutex_, turn_deadline());
  if (!lock) throw CommandError(CommandError::Kind::busy, "other robots are being looked into");
  const Workplace place(data_);
  return look_into(upload, place.folder());
}

Json RobotUploads::store(const RobotUpload& upload) {
  check_name(upload.name);
  const std::unique_lock lock(mutex_, turn_deadline());
  if (!lock) throw CommandError(CommandError::Kind::busy, "other robots are being looked into");
  const std::vector<std::string> taken = library_.names();
  if (std::find(taken.begin(), taken.end(), upload.name) != taken.end()) {
    throw CommandError(CommandError::Kind::conflict,
                       "there is a robot \"" + upload.name + "\" already");
  }
  if (library_.upload_count() >= most_robots) {
    throw CommandError(CommandError::Kind::conflict, "there are " + std::to_string(most_robots) +
                                                         " uploaded robots already; delete some");
  }
  const Workplace place(data_);
  Json report = look_into(upload, place.folder());
  library_.add_upload(place.folder(), upload.name);
  return report;
}

void RobotUploads::remove(const std::string& name) {
  const std::lock_guard lock(mutex_);
  const std::vector<std::string> known = library_.names();
  if (std::find(known.begin(), known.end(), name) == known.end()) {
    throw CommandError(CommandError::Kind::not_found, "there is no robot \"" + name + "\"");
  }
  if (!library_.is_uploaded(name)) {
    throw CommandError(CommandError::Kind::conflict,
                       "robot \"" + name + "\" was not uploaded and stays");
  }
  library_.remove_upload(name);
}

Json RobotUploads::look_into(const RobotUpload& upload, const fs::path& folder) {
  if (upload.meshes.size() > most_meshes) {
    throw RobotRefused("mesh", "there are " + std::to_string(upload.meshes.size()) +
                                   " of them; allowed: at most " + std::to_string(most_meshes));
  }
  for (const auto& [path, content] : upload.meshes) check_mesh(path);
  for (const auto& [path, content] : upload.meshes) {
    std::error_code error;
    if (fs::exists(folder / path, error)) throw RobotRefused("mesh", path + " is given twice");
    write_file(folder / path, content);
  }
  write_file(folder / sim::stranger_mark,
             "Uploaded: nothing outside this folder is read for it.\n");
  write_file(folder / "robot.urdf", upload.urdf);
  ChildOptions child;
  child.program = program_;
  child.folder = folder;
  child.patience = check_patience;
  child.arguments = {"robots", "check", "robot.urdf", "--json", "--untrusted", "--load"};
  if (upload.description.empty()) {
    child.arguments.insert(child.arguments.end(), {"--write", "."});
  } else {
    write_file(folder / "robot.json", kept_description(upload.description));
  }
  const ChildResult result = run_child(child, stopping_);
  switch (result.end) {
    case ChildResult::End::stopped:
      throw CommandError(CommandError::Kind::stopping, "the server is stopping");
    case ChildResult::End::too_long:
    case ChildResult::End::killed:
      throw RobotRefused("urdf", "takes more time or memory to look into than a robot does");
    case ChildResult::End::exited:
      break;
  }
  if (result.code != 0) {
    const bool of_description = result.err.find("robot.json") != std::string::npos;
    throw RobotRefused(of_description ? "description" : "urdf", told(result.err));
  }
  Json report = Json::parse(result.out, nullptr, false);
  if (report.is_discarded()) {
    throw CommandError(CommandError::Kind::failed, "the check of the robot told nothing");
  }
  report.erase("urdf");
  return report;
}

}  // namespace stagger::server
