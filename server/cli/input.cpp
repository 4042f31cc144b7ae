#include "server/cli/input.h"

#include <fstream>
#include <iostream>
#include <iterator>
#include <stdexcept>

namespace stagger::server {

std::string read_input(const std::string& file) {
  const auto all = [](std::istream& in) {
    return std::string(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
  };
  if (file == "-") return all(std::cin);
  std::ifstream in(file, std::ios::binary);
  if (!in) throw std::runtime_error("cannot read " + file);
  return all(in);
}

}  // namespace stagger::server
