#include "sim/robot/mesh_file.h"

#include <assimp/DefaultIOSystem.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <assimp/Importer.hpp>
#include <cmath>
#include <stdexcept>

namespace stagger::sim {
namespace {

namespace fs = std::filesystem;
using engine::Vec3;

// No robot's collision mesh needs more; a file that is greater is not what it says it is.
constexpr std::uintmax_t max_file_bytes = 256U << 20U;
constexpr std::uintmax_t max_stranger_bytes = 32U << 20U;
constexpr std::size_t max_stranger_points = 500000;

constexpr std::string_view package_scheme = "package://";
constexpr std::string_view file_scheme = "file://";

/// The path without the ".." and "." that it begins with.
fs::path without_dots(const fs::path& path) {
  fs::path result;
  for (const fs::path& part : path.lexically_normal()) {
    if (part != ".." && part != "." && part != "/") result /= part;
  }
  return result;
}

bool is_file(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

std::optional<fs::path> find_in_package(const std::string& path, const fs::path& folder) {
  const fs::path in_packages = without_dots(path);  // package/rest
  fs::path rest;
  for (auto part = std::next(in_packages.begin()); part != in_packages.end(); ++part) {
    rest /= *part;
  }
  std::error_code ignored;
  fs::path at = fs::absolute(folder, ignored).lexically_normal();
  if (!at.has_filename()) at = at.parent_path();
  for (;; at = at.parent_path()) {
    if (is_file(at / in_packages)) return at / in_packages;
    if (at.filename() == *in_packages.begin() && is_file(at / rest)) return at / rest;
    if (at == at.parent_path()) break;
  }
  return std::nullopt;
}

/// Opens the one file, and none that it refers to (materials, parts of a scene, devices).
class OneFile final : public Assimp::DefaultIOSystem {
 public:
  explicit OneFile(std::string name) : name_(std::move(name)) {}
  bool Exists(const char* name) const override {
    return name_ == name && DefaultIOSystem::Exists(name);
  }
  Assimp::IOStream* Open(const char* name, const char* mode) override {
    return name_ == name ? DefaultIOSystem::Open(name, mode) : nullptr;
  }

 private:
  std::string name_;
};

void check_stranger(const fs::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension != ".stl" && extension != ".obj" && extension != ".dae") {
    throw std::runtime_error(file.string() +
                             ": is no mesh that may be uploaded; allowed: .stl, "
                             ".obj, .dae");
  }
  std::error_code ignored;
  if (fs::file_size(file, ignored) > max_stranger_bytes) {
    throw std::runtime_error(file.string() + ": is greater than 32 MB");
  }
}

/// Directions in a frame with z up: rings, turned by 15 degrees so that none is square to an edge
/// of a foot that looks along an axis; such a direction would leave it to chance which end it gets.
std::vector<Vec3> directions() {
  std::vector<Vec3> result;
  const auto ring = [&](int count, double z) {
    for (int i = 0; i < count; ++i) {
      const double angle = (i + 0.5) * 2.0 * M_PI / count + (count == 12 ? 0.0 : 0.1);
      result.emplace_back(std::cos(angle), std::sin(angle), z);
    }
  };
  ring(12, -4.0);
  ring(12, -0.5);
  ring(7, 1.0);
  result.emplace_back(0.0, 0.0, 1.0);
  return result;
}

}  // namespace

fs::path mesh_place(const std::string& uri) {
  if (uri.starts_with(package_scheme)) return without_dots(uri.substr(package_scheme.size()));
  const fs::path path = uri.starts_with(file_scheme) ? uri.substr(file_scheme.size()) : uri;
  if (path.is_absolute()) return fs::path("meshes") / path.filename();
  return without_dots(path);
}

Trust trust_in(const fs::path& folder) {
  std::error_code error;
  const bool marked = fs::exists(folder / stranger_mark, error);
  return marked || error ? Trust::stranger : Trust::own;
}

std::optional<fs::path> find_mesh(const std::string& uri, const fs::path& folder, Trust trust) {
  const fs::path place = mesh_place(uri);
  if (place.empty()) return std::nullopt;
  if (trust == Trust::stranger) {
    // mesh_place() has taken the ways out of the folder away; a link would be another.
    std::error_code error;
    if (!is_file(folder / place) || fs::is_symlink(folder / place, error)) return std::nullopt;
    return folder / place;
  }
  if (uri.starts_with(package_scheme)) {
    if (const auto found = find_in_package(uri.substr(package_scheme.size()), folder)) return found;
  } else {
    const fs::path path = uri.starts_with(file_scheme) ? uri.substr(file_scheme.size()) : uri;
    // An absolute path stands for itself here.
    if (is_file(folder / path)) return folder / path;
    // Some files say "meshes/foot.stl" and mean the folder beside the URDF's own.
    if (path.is_relative() && is_file(folder / ".." / path)) return folder / ".." / path;
  }
  if (is_file(folder / place)) return folder / place;
  return std::nullopt;
}

std::vector<Vec3> read_mesh(const fs::path& file, Trust trust) {
  if (trust == Trust::stranger) check_stranger(file);
  std::error_code ignored;
  if (fs::file_size(file, ignored) > max_file_bytes) {
    throw std::runtime_error(file.string() + ": is greater than 256 MB");
  }
  Assimp::Importer importer;
  // The importer owns it.
  if (trust == Trust::stranger) importer.SetIOHandler(new OneFile(file.string()));
  // Moves the vertices to where the file's nodes put them, and drops all but the positions.
  importer.SetPropertyInteger(AI_CONFIG_PP_RVC_FLAGS,
                              aiComponent_NORMALS | aiComponent_TEXCOORDS | aiComponent_COLORS |
                                  aiComponent_MATERIALS | aiComponent_TEXTURES);
  const aiScene* scene =
      importer.ReadFile(file.string(), aiProcess_RemoveComponent | aiProcess_PreTransformVertices);
  if (scene == nullptr) {
    throw std::runtime_error(file.string() + ": " + importer.GetErrorString());
  }
  std::vector<Vec3> points;
  for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
    const aiMesh& mesh = *scene->mMeshes[m];
    if (trust == Trust::stranger && points.size() + mesh.mNumVertices > max_stranger_points) {
      throw std::runtime_error(file.string() + ": has more than " +
                               std::to_string(max_stranger_points) + " vertices");
    }
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
      const aiVector3D& v = mesh.mVertices[i];
      points.emplace_back(v.x, v.y, v.z);
      if (!points.back().allFinite()) {
        throw std::runtime_error(file.string() + ": has a vertex that is not finite");
      }
    }
  }
  if (points.empty()) throw std::runtime_error(file.string() + ": has no vertex");
  return points;
}

std::vector<Vec3> hull_points(const std::vector<Vec3>& points, const Vec3& up) {
  const Eigen::Matrix3d turn =
      Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), up).toRotationMatrix();
  std::vector<Vec3> result;
  for (const Vec3& direction : directions()) {
    const Vec3 d = turn * direction;
    const auto far =
        std::max_element(points.begin(), points.end(),
                         [&](const Vec3& a, const Vec3& b) { return d.dot(a) < d.dot(b); });
    if (std::find(result.begin(), result.end(), *far) == result.end()) result.push_back(*far);
  }
  return result;
}

}  // namespace stagger::sim
