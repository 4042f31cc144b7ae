// What has to be known of a request's head before anybody reads it.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace stagger::server {

/// Bytes of the body that follows this head. Nothing when only a reader finds out: the body comes
/// in chunks, its client waits for a word before it is sent, or its length is told badly.
std::optional<std::size_t> body_length(std::string_view head);

}  // namespace stagger::server
