// Arrays of fields as transforms and vector registers want them.
#pragma once

#include <complex>
#include <cstddef>
#include <new>
#include <utility>
#include <vector>

#include "base/rooms.h"

namespace papilla::numerics {

// At multiples of 64 bytes: a register's, and what the plans of transforms are made for.
template <class T>
struct AlignedAllocator {
  using value_type = T;
  AlignedAllocator() = default;
  template <class U>
  AlignedAllocator(const AlignedAllocator<U>&) {}
  T* allocate(std::size_t n) {
    return static_cast<T*>(::operator new (n * sizeof(T), std::align_val_t{64}));
  }
  void deallocate(T* p, std::size_t) { ::operator delete (p, std::align_val_t{64}); }
  template <class U>
  bool operator==(const AlignedAllocator<U>&) const {
    return true;
  }
};
template <class T>
using AlignedArray = std::vector<T, AlignedAllocator<T>>;
using RealArray = AlignedArray<double>;
using SpectrumArray = AlignedArray<std::complex<double>>;

// The same without zeros at the start: for what is written as a whole before it is read.
template <class T>
struct UnsetAllocator : AlignedAllocator<T> {
  template <class U>
  struct rebind {
    using other = UnsetAllocator<U>;
  };
  using AlignedAllocator<T>::AlignedAllocator;
  template <class U>
  void construct(U* at) {
    ::new (static_cast<void*>(at)) U;
  }
  template <class U, class... Values>
  void construct(U* at, Values&&... values) {
    ::new (static_cast<void*>(at)) U(std::forward<Values>(values)...);
  }
};
template <class T>
using UnsetArray = std::vector<T, UnsetAllocator<T>>;

}  // namespace papilla::numerics
