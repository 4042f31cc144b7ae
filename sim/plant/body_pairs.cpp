#include "sim/plant/body_pairs.h"

namespace stagger::sim {
namespace {

/// The nearest body towards the base that has shapes; -1 when there is none.
int carrier(const RobotModel& model, int body) {
  int i = model.bodies[body].parent;
  while (i >= 0 && model.bodies[i].shapes.empty()) i = model.bodies[i].parent;
  return i;
}

}  // namespace

BodyPairs::BodyPairs(const RobotModel& model)
    : count_(model.bodies.size()), may_touch_(count_ * count_, false) {
  const auto count = static_cast<int>(count_);
  for (int first = 0; first < count; ++first) {
    if (model.bodies[first].shapes.empty()) continue;
    for (int second = first + 1; second < count; ++second) {
      // Parents come before children: only the second can hang on the first.
      if (model.bodies[second].shapes.empty() || carrier(model, second) == first) continue;
      may_touch_[cell(first, second)] = true;
      may_touch_[cell(second, first)] = true;
    }
  }
}

void BodyPairs::forbid(int first, int second) {
  may_touch_[cell(first, second)] = false;
  may_touch_[cell(second, first)] = false;
}

std::vector<std::pair<int, int>> BodyPairs::list() const {
  std::vector<std::pair<int, int>> pairs;
  const auto count = static_cast<int>(count_);
  for (int first = 0; first < count; ++first) {
    for (int second = first + 1; second < count; ++second) {
      if (may_touch(first, second)) pairs.emplace_back(first, second);
    }
  }
  return pairs;
}

}  // namespace stagger::sim
