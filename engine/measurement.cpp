#include "engine/measurement.h"

#include <stdexcept>

namespace stagger::engine {

void validate(const Measurement& start) {
  if (!plausible(start.com) || !plausible(start.com_velocity) || !plausible(start.feet[0]) ||
      !plausible(start.feet[1])) {
    throw std::invalid_argument("the first measurement is not finite");
  }
}

}  // namespace stagger::engine
