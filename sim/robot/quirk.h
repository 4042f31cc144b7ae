// What is odd about a robot's files, and what was made of it.
#pragma once

#include <string>
#include <vector>

namespace stagger::sim {

struct Quirk {
  std::string where;   ///< "link 'foot'", "joint 'knee'", ...
  std::string what;    ///< as found
  std::string answer;  ///< what was done about it, or what its owner should do
};

using Quirks = std::vector<Quirk>;

}  // namespace stagger::sim
