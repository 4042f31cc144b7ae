// Files of a folder as answers: the dashboard, and the robots' models.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "server/http/message.h"

namespace stagger::server {

/// The file at `path` below `folder`, or nothing when there is no such file there. Never leaves the
/// folder, whatever `path` or a symbolic link says.
std::optional<std::filesystem::path> file_below(const std::filesystem::path& folder,
                                                const std::string& path);

/// The file's content, its type from its extension.
HttpResponse file_response(const std::filesystem::path& file);

/// Answers for the dashboard in `folder`: index.html at "/", else the file. A page that says how to
/// build it where it has not been built. Throws Problem(404).
HttpResponse dashboard_response(const std::filesystem::path& folder, const std::string& path);

}  // namespace stagger::server
