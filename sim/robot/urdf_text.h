// The text of a URDF through urdfdom, whatever the text is.
#pragma once

#include <urdf_parser/urdf_parser.h>

#include <string>
#include <vector>

namespace stagger::sim {

/// Parses the text. `warnings`: what urdfdom had to say about a text that it took. Throws
/// std::runtime_error with urdfdom's messages when it did not take it, and for what would break a
/// reader: nesting deeper than 64, more than 64 MB, more than 5000 links, no root, a link that
/// hangs on two joints, links that hang on each other.
urdf::ModelInterfaceSharedPtr parse_urdf(const std::string& xml, const std::string& origin,
                                         std::vector<std::string>* warnings = nullptr);

}  // namespace stagger::sim
