// Meshes of collision geometry: where their files are, and the few points that matter of them.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/types.h"

namespace stagger::sim {

/// Whose files they are. A stranger's may name no file outside their own folder, are of the formats
/// that robots use, and are kept to sizes that cost little.
enum class Trust : std::uint8_t { own, stranger };

/// A folder with a file of this name holds a stranger's files, whoever reads them and when.
inline constexpr const char* stranger_mark = ".stranger";
Trust trust_in(const std::filesystem::path& folder);

/// Greatest number of points that a mesh is reduced to.
inline constexpr std::size_t max_hull_points = 32;

/// Where a mesh is kept below the folder of a robot that was copied together: package://p/a/b.stl
/// as p/a/b.stl, a relative path without its leading "..", an absolute one as meshes/<file name>.
std::filesystem::path mesh_place(const std::string& uri);

/// The file that a mesh URI of a URDF in `folder` means: package://, file:// or a bare path. A
/// package is looked for in `folder` and in every folder above it, by its name; what is found
/// nowhere else may lie below `folder` as mesh_place() says, which is the only place where a
/// stranger's is looked for. Nothing when there is no such file.
std::optional<std::filesystem::path> find_mesh(const std::string& uri,
                                               const std::filesystem::path& folder,
                                               Trust trust = Trust::own);

/// Vertices of an STL, OBJ or DAE file, in the file's own frame; a file's unit and up axis are
/// applied. A stranger's file opens no other file, whatever it says. Throws std::runtime_error:
/// unreadable, no vertex, a vertex that is not finite; of a stranger's also above 32 MB, above
/// 500000 vertices, and any other format.
std::vector<engine::Vec3> read_mesh(const std::filesystem::path& file, Trust trust = Trust::own);

/// Extreme points in fixed directions, at most max_hull_points of them, each once, in a fixed
/// order. `up`: z of the world, in the points' frame; most directions look at the underside, which
/// is what a foot stands on.
std::vector<engine::Vec3> hull_points(const std::vector<engine::Vec3>& points,
                                      const engine::Vec3& up);

}  // namespace stagger::sim
