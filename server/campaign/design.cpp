#include "server/campaign/design.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "server/campaign/hash.h"

namespace stagger::server::campaign {

using nlohmann::json;

Round Round::range(std::uint64_t count) {
  Round round;
  round.count_ = count;
  return round;
}

Round Round::list(std::vector<std::uint64_t> numbers) {
  Round round;
  round.list_ = std::move(numbers);
  return round;
}

Round Round::share(std::uint64_t index, std::uint64_t count) const {
  Round round;
  if (index >= size()) return round;
  if (list_.empty()) {
    round.count_ = (size() - index + count - 1) / count;
    round.first_ = first_ + index * stride_;
    round.stride_ = stride_ * count;
  }
  for (std::uint64_t i = index; i < list_.size(); i += count) round.list_.push_back(list_[i]);
  return round;
}

Design::Design(const CampaignSpec& spec) : spec_(spec), repeats_(spec.design.repeats) {
  // Saturates far beyond what any campaign may have, and far below an overflow.
  constexpr std::uint64_t most = std::uint64_t{1} << 40U;
  const auto times = [](std::uint64_t a, std::uint64_t b) {
    return b == 0 || a <= most / b ? a * b : most;
  };
  if (spec.design.kind == DesignKind::random) {
    cells_ = spec.design.samples;
  } else {
    for (const Factor& factor : spec.factors) cells_ = times(cells_, factor.values.size());
    if (spec.design.kind == DesignKind::list) cells_ = times(cells_, spec.design.entries.size());
  }
  if (!is_bisection()) return;
  const Bisection& b = spec.design.bisection;
  // A last level that lies a hair above hi is hi.
  const auto steps = static_cast<std::uint64_t>(std::ceil((b.hi - b.lo) / b.tol - 1e-9));
  levels_ = std::max<std::uint64_t>(steps, 1) + 1;
  const std::uint64_t scan = std::min<std::uint64_t>(b.scan, levels_);
  for (std::uint64_t i = 0; i < scan; ++i) {
    scan_.push_back((i * (levels_ - 1) + (scan - 1) / 2) / (scan - 1));
  }
}

std::uint64_t Design::most_trials() const {
  if (!is_bisection()) return numbers();
  std::uint64_t widest = 1;
  for (std::size_t i = 1; i < scan_.size(); ++i) widest = std::max(widest, scan_[i] - scan_[i - 1]);
  // Halving a gap of n levels takes as many more as n - 1 has bits.
  const auto halvings = static_cast<std::uint64_t>(std::bit_width(widest - 1));
  return cells_ * (scan_.size() + halvings) * repeats_;
}

Place Design::place(std::uint64_t number) const {
  Place place;
  place.repeat = number % repeats_;
  number /= repeats_;
  place.level = number % levels_;
  place.cell = number / levels_;
  return place;
}

std::uint64_t Design::number(const Place& place) const {
  return (place.cell * levels_ + place.level) * repeats_ + place.repeat;
}

double Design::level(std::uint64_t index) const {
  const Bisection& b = spec_.design.bisection;
  constexpr double digits = 1e9;
  if (index + 1 >= levels_) return b.hi;
  return std::round((b.lo + static_cast<double>(index) * b.tol) * digits) / digits;
}

json Design::drawn(const Factor& factor, std::uint64_t cell) const {
  // Each factor draws for itself: one more factor does not change what the others are.
  const double share = unit_interval(mixed(hash_text(factor.path, mixed(spec_.seed)), cell));
  if (!factor.interval) {
    const auto count = static_cast<double>(factor.values.size());
    return factor.values[static_cast<std::size_t>(share * count)];
  }
  const auto [lo, hi, logarithmic] = *factor.interval;
  return logarithmic ? lo * std::pow(hi / lo, share) : lo + (hi - lo) * share;
}

std::vector<Setting> Design::settings(const Place& place) const {
  std::vector<Setting> settings;
  std::uint64_t rest = place.cell;
  if (spec_.design.kind == DesignKind::random) {
    for (const Factor& factor : spec_.factors) {
      settings.emplace_back(factor.path, drawn(factor, place.cell));
    }
    return settings;
  }
  for (std::size_t i = spec_.factors.size(); i-- > 0;) {
    const Factor& factor = spec_.factors[i];
    settings.emplace_back(factor.path, factor.values[rest % factor.values.size()]);
    rest /= factor.values.size();
  }
  if (spec_.design.kind == DesignKind::list) {
    const Entry& entry = spec_.design.entries[rest];
    settings.insert(settings.end(), entry.settings.rbegin(), entry.settings.rend());
    settings.emplace_back("name", entry.name);
  }
  std::reverse(settings.begin(), settings.end());
  if (is_bisection()) settings.emplace_back(spec_.design.bisection.axis, level(place.level));
  return settings;
}

Limit Design::limit(std::uint64_t cell, const Known& known,
                    std::vector<std::uint64_t>* wanted) const {
  enum class RungState : std::uint8_t { unknown, pass, fail, undecided };
  Limit limit;
  limit.cell = cell;
  // Every repeat of a level is run, so that which trials are run depends on results alone, and
  // never on the order in which they came.
  const auto state_of = [&](std::uint64_t at) {
    std::uint64_t passed = 0;
    std::uint64_t failed = 0;
    for (std::uint64_t repeat = 0; repeat < repeats_; ++repeat) {
      const auto verdict = known.verdict(number({cell, at, repeat}));
      if (!verdict) return RungState::unknown;
      if (*verdict == Verdict::pass) ++passed;
      if (*verdict == Verdict::fail) ++failed;
    }
    limit.trials += repeats_;
    if (failed > 0) return RungState::fail;
    return passed == repeats_ ? RungState::pass : RungState::undecided;
  };

  std::optional<std::uint64_t> fail;  // lowest
  std::vector<std::uint64_t> passes;
  bool waiting = false;
  const auto look = [&](std::uint64_t at) {
    switch (state_of(at)) {
      case RungState::unknown:
        waiting = true;
        if (wanted != nullptr) wanted->push_back(at);
        break;
      case RungState::pass:
        passes.push_back(at);
        break;
      case RungState::fail:
        if (!fail || at < *fail) fail = at;
        break;
      case RungState::undecided:
        limit.undecided = true;
        break;
    }
  };
  const auto pass_below_fail = [&] {
    std::optional<std::uint64_t> best;
    for (const std::uint64_t at : passes) {
      if ((!fail || at < *fail) && (!best || at > *best)) best = at;
    }
    return best;
  };

  for (const std::uint64_t at : scan_) look(at);
  while (!waiting && !limit.undecided && fail) {
    const auto pass = pass_below_fail();
    if (!pass || *fail - *pass <= 1) break;
    look(*pass + (*fail - *pass) / 2);
  }
  limit.done = !waiting;
  limit.fail = fail;
  limit.pass = pass_below_fail();
  if (!passes.empty()) limit.highest_pass = *std::max_element(passes.begin(), passes.end());
  limit.monotone = !fail || !limit.highest_pass || *limit.highest_pass < *fail;
  return limit;
}

Round Design::next_round(const Known& known) const {
  if (!is_bisection()) {
    return known.count() >= numbers() ? Round() : Round::range(numbers());
  }
  std::vector<std::uint64_t> numbers;
  for (std::uint64_t cell = 0; cell < cells_; ++cell) {
    std::vector<std::uint64_t> wanted;
    limit(cell, known, &wanted);
    for (const std::uint64_t at : wanted) {
      for (std::uint64_t repeat = 0; repeat < repeats_; ++repeat) {
        numbers.push_back(number({cell, at, repeat}));
      }
    }
  }
  std::sort(numbers.begin(), numbers.end());
  return Round::list(std::move(numbers));
}

}  // namespace stagger::server::campaign
