// A command's options from the environment and from a file, where the command line does not set
// them.
#pragma once

#include <string>

#include "server/json/json.h"

namespace CLI {  // NOLINT(readability-identifier-naming): the library's
class App;
}

namespace stagger::server {

/// Gives each option that the command line has left out its value from the environment
/// (--stream-clients: STAGGER_STREAM_CLIENTS, lists with commas), else from the JSON object in
/// `file` ("stream_clients"; no file when empty). All are checked as on the command line. False,
/// after messages on standard error that name file or variable, field, value and what is allowed.
bool apply_settings(CLI::App& command, const std::string& file);

/// What all options now are, as such a file.
Json settings_json(const CLI::App& command);

}  // namespace stagger::server
