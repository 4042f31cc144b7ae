// Text for a shell's command line.
#pragma once

#include <string>

namespace stagger::server {

/// One word that the shell takes as it is: quoted when it has to be.
std::string shell_word(const std::string& text);

}  // namespace stagger::server
