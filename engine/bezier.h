// Bezier curves of fixed degree, by de Casteljau: exact at the ends and free of powers.
#pragma once

#include <array>
#include <cstddef>

namespace stagger::engine {

/// Value and the first two derivatives with respect to the parameter s in [0, 1].
template <typename T>
struct CurvePoint {
  T value;
  T first;
  T second;
};

template <typename T, std::size_t Degree>
CurvePoint<T> evaluate_bezier(std::array<T, Degree + 1> p, double s) {
  static_assert(Degree >= 2);
  for (std::size_t level = Degree; level > 2; --level) {
    for (std::size_t i = 0; i < level; ++i) p[i] = (1.0 - s) * p[i] + s * p[i + 1];
  }
  constexpr double n = static_cast<double>(Degree);
  CurvePoint<T> point;
  point.second = n * (n - 1.0) * (p[2] - 2.0 * p[1] + p[0]);
  const T a = (1.0 - s) * p[0] + s * p[1];
  const T b = (1.0 - s) * p[1] + s * p[2];
  point.first = n * (b - a);
  point.value = (1.0 - s) * a + s * b;
  return point;
}

/// Control points of the part of the curve from s to 1, as a curve of its own over [0, 1].
template <typename T, std::size_t Degree>
std::array<T, Degree + 1> rest_of_bezier(std::array<T, Degree + 1> p, double s) {
  for (std::size_t level = Degree; level > 0; --level) {
    for (std::size_t i = 0; i < level; ++i) p[i] = (1.0 - s) * p[i] + s * p[i + 1];
  }
  // After the sweep p[0] is the point at s and p[i] the last point that level Degree - i left
  // there.
  return p;
}

}  // namespace stagger::engine
