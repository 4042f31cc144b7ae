// The keys of the server, from files or the environment: never from the command line, where every
// user of the machine could read them.
#pragma once

#include <optional>
#include <string>

#include "server/http/access.h"

namespace stagger::server {

/// Each from its file when one is named, else from STAGGER_API_KEY or STAGGER_READ_ONLY_KEY, else
/// none. Nothing, after a message on standard error, when a file cannot be read or what it holds
/// cannot be a key.
std::optional<ApiKeys> read_api_keys(const std::string& full_file,
                                     const std::string& read_only_file);

}  // namespace stagger::server
