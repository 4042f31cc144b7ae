// What a command reads as a whole.
#pragma once

#include <string>

namespace stagger::server {

/// All of a file, or of standard input for "-". Throws std::runtime_error when it cannot be read.
std::string read_input(const std::string& file);

}  // namespace stagger::server
