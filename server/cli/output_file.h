// A file that is written when the work is done.
#pragma once

#include <fstream>
#include <stdexcept>
#include <string>
#include <utility>

namespace stagger::server {

/// Is tried before the work: nobody wants to wait for what cannot be written. What the file holds
/// stays until then, whatever comes of the work. Without a name there is none.
class OutputFile {
 public:
  OutputFile(std::string option, std::string name)
      : option_(std::move(option)), name_(std::move(name)) {
    if (!name_.empty() && !std::ofstream(name_, std::ios::binary | std::ios::app)) fail();
  }
  void write(const std::string& text) const {
    if (name_.empty()) return;
    std::ofstream file(name_, std::ios::binary);
    file << text;
    file.close();
    if (!file) fail();
  }

 private:
  [[noreturn]] void fail() const { throw std::runtime_error(option_ + ": cannot write " + name_); }

  std::string option_;
  std::string name_;
};

}  // namespace stagger::server
