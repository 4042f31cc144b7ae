// How pages and figures look: colours by meaning, for the screen, in the dark and on paper.
#pragma once

#include <string>

namespace stagger::server {

/// The style sheet of a page; it follows the reader's choice of light or dark, and prints light.
std::string page_style();

/// That of a figure in a file of its own, always light. Colours stand as they are: programs that
/// set papers know no variables.
std::string figure_style();

}  // namespace stagger::server
