// Answers that are kept, so that a request which is sent again is not carried out again.
#pragma once

#include <cstddef>
#include <functional>
#include <list>
#include <mutex>
#include <string>

#include "server/http/message.h"

namespace stagger::server {

/// The header Idempotency-Key: the same key with the same body gets the first answer again. Only
/// what was carried out is kept; a request that was refused may be mended and sent again. Safe to
/// use from several threads.
class Idempotency {
 public:
  static constexpr std::size_t max_key = 128;        ///< bytes, printable ASCII
  static constexpr std::size_t max_kept = 1000;      ///< answers
  static constexpr std::size_t max_bytes = 4 << 20;  ///< of keys, bodies and answers together

  /// Runs `action` unless its answer is kept. A request without a key is just run. Throws Problem:
  /// 422 for a key that came with another body, or that is none; 409 while the first request with
  /// this key is under way.
  HttpResponse run(const HttpRequest& request, const std::function<HttpResponse()>& action);

 private:
  struct Kept {
    std::string key;
    std::string body;
    HttpResponse answer;
    bool under_way = true;
    std::size_t bytes() const { return key.size() + body.size() + answer.body.size(); }
  };

  void forget_oldest();

  std::mutex mutex_;
  std::list<Kept> kept_;  ///< oldest first
  std::size_t bytes_ = 0;
};

}  // namespace stagger::server
