#include "server/http/idempotency.h"

#include <algorithm>

#include "server/http/problem.h"

namespace stagger::server {
namespace {

void check_key(const std::string& key) {
  const bool printable =
      std::all_of(key.begin(), key.end(), [](char c) { return c > ' ' && c < '\x7f'; });
  if (printable && key.size() <= Idempotency::max_key) return;
  throw Problem(422, "Idempotency-Key is not of 1 to " + std::to_string(Idempotency::max_key) +
                         " printable characters without spaces");
}

}  // namespace

HttpResponse Idempotency::run(const HttpRequest& request,
                              const std::function<HttpResponse()>& action) {
  const std::string key = request.header("idempotency-key");
  if (key.empty()) return action();
  check_key(key);
  std::list<Kept>::iterator mine;
  {
    const std::lock_guard lock(mutex_);
    const auto found = std::find_if(kept_.begin(), kept_.end(),
                                    [&key](const Kept& kept) { return kept.key == key; });
    if (found != kept_.end()) {
      if (found->body != request.body) {
        throw Problem(422, "this Idempotency-Key has come with another body before");
      }
      if (found->under_way) {
        throw Problem(409, "the first request with this Idempotency-Key is still under way");
      }
      HttpResponse again = found->answer;
      again.headers.emplace_back("Idempotency-Replayed", "true");
      return again;
    }
    mine = kept_.insert(kept_.end(), {key, request.body, {}, true});
    bytes_ += mine->bytes();
  }
  try {
    HttpResponse answer = action();
    const std::lock_guard lock(mutex_);
    bytes_ -= mine->bytes();
    mine->answer = answer;
    mine->under_way = false;
    bytes_ += mine->bytes();
    forget_oldest();
    return answer;
  } catch (...) {
    const std::lock_guard lock(mutex_);
    bytes_ -= mine->bytes();
    kept_.erase(mine);
    throw;
  }
}

void Idempotency::forget_oldest() {
  auto oldest = kept_.begin();
  while (oldest != kept_.end() && (kept_.size() > max_kept || bytes_ > max_bytes)) {
    if (oldest->under_way) {
      ++oldest;
      continue;
    }
    bytes_ -= oldest->bytes();
    oldest = kept_.erase(oldest);
  }
}

}  // namespace stagger::server
