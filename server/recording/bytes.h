// Little-endian numbers and strings, as MCAP and ROS messages hold them; reading never goes beyond
// the end.
#pragma once

#include <zlib.h>

#include <bit>
#include <cstdint>
#include <cstring>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>

namespace stagger::server {

static_assert(std::endian::native == std::endian::little, "numbers are copied as they are");

/// Bytes that are not what they should be.
class BadBytes : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

template <typename Number>
void put(std::string& out, Number value) {
  char bytes[sizeof value];
  std::memcpy(bytes, &value, sizeof value);
  out.append(bytes, sizeof value);
}

/// Length in 32 bits, then the bytes.
inline void put_text(std::string& out, std::string_view text) {
  put(out, static_cast<std::uint32_t>(text.size()));
  out += text;
}

/// CRC-32 over what came before and these bytes.
inline std::uint32_t crc_over(std::uint32_t before, std::string_view bytes) {
  return static_cast<std::uint32_t>(
      crc32_z(before, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}

  std::size_t left() const { return bytes_.size() - at_; }

  std::string_view take(std::uint64_t size) {
    if (size > left()) throw BadBytes("ends too early");
    const std::string_view part = bytes_.substr(at_, size);
    at_ += size;
    return part;
  }

  template <typename Number>
  Number number() {
    Number value{};
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
    return value;
  }

  std::string_view text() { return take(number<std::uint32_t>()); }

  std::map<std::string, std::string> text_map() {
    ByteReader entries(text());
    std::map<std::string, std::string> map;
    while (entries.left() > 0) {
      const std::string_view key = entries.text();
      map[std::string(key)] = entries.text();
    }
    return map;
  }

 private:
  std::string_view bytes_;
  std::size_t at_ = 0;
};

}  // namespace stagger::server
