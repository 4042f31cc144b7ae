// Which trials a campaign has, and in which rounds they are run: numbers in, settings out.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "server/campaign/spec.h"

namespace stagger::server::campaign {

/// What a trial says about its push.
enum class Verdict : std::uint8_t {
  pass,
  fail,      ///< it fell, or was not back in time
  undecided  ///< the push never came: counts neither way
};

/// The trials that have been run so far.
class Known {
 public:
  Known() = default;
  Known(const Known&) = delete;
  Known& operator=(const Known&) = delete;
  virtual ~Known() = default;
  /// How many.
  virtual std::uint64_t count() const = 0;
  /// Nothing for a trial that has not been run.
  virtual std::optional<Verdict> verdict(std::uint64_t number) const = 0;
};

/// Trial numbers to be run in any order, ascending: a range, or a list.
class Round {
 public:
  Round() = default;
  static Round range(std::uint64_t count);
  static Round list(std::vector<std::uint64_t> numbers);

  bool empty() const { return size() == 0; }
  std::uint64_t size() const { return list_.empty() ? count_ : list_.size(); }
  std::uint64_t operator[](std::uint64_t i) const {
    return list_.empty() ? first_ + i * stride_ : list_[i];
  }
  /// Every `count`th trial from the one at `index` on: what one of `count` machines takes.
  Round share(std::uint64_t index, std::uint64_t count) const;

 private:
  std::uint64_t count_ = 0;  ///< of a range
  std::uint64_t first_ = 0;
  std::uint64_t stride_ = 1;
  std::vector<std::uint64_t> list_;
};

/// Where a trial stands in the design.
struct Place {
  std::uint64_t cell = 0;    ///< combination of factors, or sample
  std::uint64_t level = 0;   ///< on the axis of a bisection
  std::uint64_t repeat = 0;  ///< 0, 1, ...
};

/// How far the axis of a bisection may go in one cell; of the levels that were tried, by index.
struct Limit {
  std::uint64_t cell = 0;
  std::optional<std::uint64_t> pass;  ///< greatest below `fail` at which all repeats pass
  std::optional<std::uint64_t> fail;  ///< lowest at which a repeat fails
  /// Greatest of all at which all repeats pass: above `fail` when survival is not monotone.
  std::optional<std::uint64_t> highest_pass;
  bool monotone = true;
  bool undecided = false;    ///< a trial said nothing: so does this limit
  bool done = false;         ///< pass and fail are neighbours, or there is no more to try
  std::uint64_t trials = 0;  ///< of this cell so far
};

/// A function of the specification alone: the same trial number is the same trial wherever and
/// whenever it is run.
class Design {
 public:
  explicit Design(const CampaignSpec& spec);

  std::uint64_t cells() const { return cells_; }
  /// Trial numbers are below this.
  std::uint64_t numbers() const { return cells_ * levels_ * repeats_; }
  /// Trials that are run at the most.
  std::uint64_t most_trials() const;

  Place place(std::uint64_t number) const;
  std::uint64_t number(const Place& place) const;
  /// Value of the axis [its unit].
  double level(std::uint64_t index) const;
  /// What the trial of that place sets, in the order in which it is set. A list's entry comes first
  /// as "name".
  std::vector<Setting> settings(const Place& place) const;

  /// Trials whose results are wanted next; empty when the campaign is complete. Asks for the same
  /// trials again until they are known.
  Round next_round(const Known& known) const;
  /// Of a bisection: what is known of a cell so far, and the levels that are wanted next.
  Limit limit(std::uint64_t cell, const Known& known,
              std::vector<std::uint64_t>* wanted = nullptr) const;
  bool is_bisection() const { return spec_.design.kind == DesignKind::bisect; }

 private:
  nlohmann::json drawn(const Factor& factor, std::uint64_t cell) const;

  const CampaignSpec& spec_;
  std::uint64_t cells_ = 1;
  std::uint64_t levels_ = 1;
  std::uint64_t repeats_ = 1;
  std::vector<std::uint64_t> scan_;  ///< levels of the coarse scan
};

}  // namespace stagger::server::campaign
