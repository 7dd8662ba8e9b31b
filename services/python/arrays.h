// Memory of ours as NumPy arrays, without copies.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace dispersa {

/// An array of this shape over memory of `owner`. The array's base is a capsule that holds the owner, so the
/// memory lives as long as the array's last view.
template <typename T, typename Owner>
pybind11::array_t<T> ArrayOver(T* data, std::vector<pybind11::ssize_t> shape, Owner owner) {
  auto kept = std::make_unique<Owner>(std::move(owner));
  pybind11::capsule base(kept.get(), [](void* pointer) { delete static_cast<Owner*>(pointer); });
  kept.release();
  return pybind11::array_t<T>(std::move(shape), data, base);
}

/// A vector that becomes an array.
template <typename T>
pybind11::array_t<T> ArrayOf(std::vector<T> values, std::vector<pybind11::ssize_t> shape) {
  auto owner = std::make_unique<std::vector<T>>(std::move(values));
  T* const data = owner->data();
  return ArrayOver<T>(data, std::move(shape), std::move(owner));
}
template <typename T>
pybind11::array_t<T> ArrayOf(std::vector<T> values) {
  const auto size = static_cast<pybind11::ssize_t>(values.size());
  return ArrayOf(std::move(values), {size});
}

}  // namespace dispersa
