#include "server/http/static_files.h"

#include <fstream>
#include <iterator>
#include <map>
#include <system_error>

#include "server/http/message.h"
#include "server/http/problem.h"

namespace stagger::server {
namespace {

namespace fs = std::filesystem;

std::string type_of(const fs::path& file) {
  static const std::map<std::string, std::string> types{
      {".html", "text/html; charset=utf-8"},
      {".js", "text/javascript; charset=utf-8"},
      {".mjs", "text/javascript; charset=utf-8"},
      {".css", "text/css; charset=utf-8"},
      {".json", "application/json"},
      {".map", "application/json"},
      {".webmanifest", "application/manifest+json"},
      {".svg", "image/svg+xml"},
      {".png", "image/png"},
      {".jpg", "image/jpeg"},
      {".jpeg", "image/jpeg"},
      {".ico", "image/x-icon"},
      {".woff2", "font/woff2"},
      {".wasm", "application/wasm"},
      {".urdf", "application/xml"},
      {".dae", "model/vnd.collada+xml"},
      {".stl", "model/stl"},
      {".obj", "model/obj"},
      {".txt", "text/plain; charset=utf-8"}};
  const auto found = types.find(lower(file.extension().string()));
  return found == types.end() ? "application/octet-stream" : found->second;
}

constexpr const char* not_built_page =
    "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>stagger</title>"
    "<h1>stagger is running</h1>"
    "<p>The dashboard has not been built. Build it in the checkout:</p>"
    "<pre>cd web\nnpm ci\nnpm run build</pre>"
    "<p>and load this page again. The API is at <a href=\"/api/v1/simulation\">"
    "/api/v1/simulation</a>.</p></html>";

}  // namespace

std::optional<fs::path> file_below(const fs::path& folder, const std::string& path) {
  if (path.find('\0') != std::string::npos) return std::nullopt;
  std::error_code error;
  const fs::path root = fs::canonical(folder, error);
  if (error) return std::nullopt;
  const fs::path file = fs::canonical(root / fs::path(path).relative_path(), error);
  if (error || !fs::is_regular_file(file, error)) return std::nullopt;
  const auto [end_of_root, unused] =
      std::mismatch(root.begin(), root.end(), file.begin(), file.end());
  return end_of_root == root.end() ? std::optional(file) : std::nullopt;
}

HttpResponse file_response(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw Problem(404, "the file cannot be read");
  return {200,
          type_of(file),
          std::string(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()),
          {}};
}

HttpResponse dashboard_response(const fs::path& folder, const std::string& path) {
  const bool is_page = path == "/" || path == "/index.html";
  const auto file = file_below(folder, is_page ? "/index.html" : path);
  if (!file) {
    if (!is_page) throw Problem(404, "there is nothing at " + path);
    return {200, "text/html; charset=utf-8", not_built_page, {{"Cache-Control", "no-cache"}}};
  }
  HttpResponse response = file_response(*file);
  // The names of what is in assets/ carry a hash of their content; all others may change.
  const bool hashed = path.starts_with("/assets/");
  response.headers.emplace_back("Cache-Control",
                                hashed ? "public, max-age=31536000, immutable" : "no-cache");
  return response;
}

}  // namespace stagger::server
