// Loops over arrays, written once for one pixel and for several side by side. A kernel is a generic
// lambda: it takes the place where the loop stands and reads, computes and writes there, in numbers
// whose type it does not name:
//
//   for_each_pixel(n, [&](auto at) { at.store(p, larger(at(p) - level, 0)); });
//   const double work = sum_over(n, [&](auto at) { return at(p) * at(gap); });
//   const auto [low, load] = reduce(n, [&](auto at) {
//     return std::tuple(Least(at(gap)), at(p));
//   });
//
// The loop runs it with vectors and ends with single numbers. Number k of a sum is added to the
// partial sum k modulo the size of a vector, in both: one sum on every machine. A pixel's kernel
// sees nothing that another pixel's writes.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <limits>
#include <span>
#include <tuple>
#include <type_traits>
#include <utility>

#include "base/rooms.h"
#include "numerics/vector.h"

namespace papilla::numerics {

template <class T>
struct NumberOf {
  using Type = T;
};
template <class T, int kCount>
struct NumberOf<Vector<T, kCount>> {
  using Type = T;
};

// Where a loop stands: at a pixel (T a number) or at the first of as many as T holds.
template <class T>
class Pixels {
 public:
  using Number = typename NumberOf<T>::Type;
  static constexpr bool kOne = std::is_same_v<T, Number>;

  explicit Pixels(std::size_t pixel) : pixel_(pixel) {}
  std::size_t pixel() const { return pixel_; }

  // The values here of an array or from a pointer on; they may be of another type than the loop's.
  template <class Array>
  [[gnu::always_inline]] T operator()(const Array& array) const {
    const auto* values = first_of(array);
    if constexpr (kOne) {
      return static_cast<T>(values[pixel_]);
    } else {
      return T::load(values + pixel_);
    }
  }
  // Of an array that is empty where all values are `otherwise`.
  template <class Array>
  [[gnu::always_inline]] T operator()(const Array& values, Number otherwise) const {
    return values.empty() ? T(otherwise) : (*this)(values);
  }
  // values[list[pixel]]
  template <class Array, class List>
  [[gnu::always_inline]] T listed(const Array& values, const List& list) const {
    if constexpr (kOne) {
      return values[static_cast<std::size_t>(list[pixel_])];
    } else {
      return T::gather(values.data(), Vector<int, T::kSize>::load(list.data() + pixel_));
    }
  }

  // value: a number, or what a comparison gives, as 1 and 0.
  template <class Array, class Value>
  [[gnu::always_inline]] void store(Array&& array, const Value& value) const {
    auto* values = first_of(array);
    if constexpr (kOne) {
      values[pixel_] = static_cast<std::remove_reference_t<decltype(*values)>>(value);
    } else if constexpr (std::is_arithmetic_v<Value>) {
      T(value).store(values + pixel_);
    } else {
      value.store(values + pixel_);
    }
  }
  // values[list[pixel]]; no pixel is listed twice.
  template <class Array, class List>
  [[gnu::always_inline]] void store_listed(Array& values, const List& list, const T& value) const {
    if constexpr (kOne) {
      values[static_cast<std::size_t>(list[pixel_])] = value;
    } else {
      for (int k = 0; k < T::kSize; ++k)
        values[static_cast<std::size_t>(list[pixel_ + static_cast<std::size_t>(k)])] = value[k];
    }
  }

 private:
  template <class Array>
  static auto* first_of(Array& array) {
    if constexpr (std::is_pointer_v<Array>) {
      return array;
    } else {
      return array.data();
    }
  }

  std::size_t pixel_;
};

// While one lives every loop goes pixel by pixel, in all threads: for tests, which hold the numbers
// of both ways against each other.
class PixelByPixel {
 public:
  PixelByPixel() { ++alive_; }
  ~PixelByPixel() { --alive_; }
  PixelByPixel(const PixelByPixel&) = delete;
  PixelByPixel& operator=(const PixelByPixel&) = delete;
  static bool asked() { return alive_.load(std::memory_order_relaxed) != 0; }

 private:
  static std::atomic<int> alive_;
};

// The least number of pixels not below n that loops go through without single ones.
constexpr std::size_t padded(std::size_t n) {
  constexpr std::size_t kSize = Vector<double>::kSize;
  return (n + kSize - 1) / kSize * kSize;
}

// kernel(Pixels) for each pixel of [begin, end). Real: of the loop's numbers.
template <class Real = double, class Kernel>
[[gnu::always_inline]] inline void for_each_pixel(std::size_t begin, std::size_t end,
                                                  const Kernel& kernel) {
  using V = Vector<Real>;
  std::size_t i = begin;
  if (!PixelByPixel::asked()) {
    for (; i + V::kSize <= end; i += V::kSize) kernel(Pixels<V>(i));
  }
  for (; i < end; ++i) kernel(Pixels<Real>(i));
}
template <class Real = double, class Kernel>
[[gnu::always_inline]] inline void for_each_pixel(std::size_t n, const Kernel& kernel) {
  for_each_pixel<Real>(0, n, kernel);
}

// What a kernel of reduce() gives where not the sum is asked for.
template <class T>
struct Least {
  T value;
  explicit Least(const T& of) : value(of) {}
};
template <class T>
struct Largest {
  T value;
  explicit Largest(const T& of) : value(of) {}
};

// How the values that kernels give become one: side by side while vectors are added, then each
// partial result alone. Of a Vector: sums.
template <class Value>
class Reduction;

template <class Real, int kSize>
class Reduction<Vector<Real, kSize>> {
 public:
  using Result = double;
  [[gnu::always_inline]] void add(const Vector<Real, kSize>& value) { all_ += value; }
  struct Apart {
    Real part[kSize];
    void add(std::size_t k, Real value) { part[k] += value; }
    double result() const {
      double out = 0;
      for (int k = 0; k < kSize; ++k) out += static_cast<double>(part[k]);
      return out;
    }
  };
  [[gnu::always_inline]] Apart apart() const {
    Apart out;
    all_.store(out.part);
    return out;
  }

 private:
  Vector<Real, kSize> all_{};
};

template <class Real, int kSize>
class Reduction<Least<Vector<Real, kSize>>> {
 public:
  using Result = double;
  [[gnu::always_inline]] void add(const Least<Vector<Real, kSize>>& given) {
    all_ = smaller(all_, given.value);
  }
  struct Apart {
    Real part[kSize];
    void add(std::size_t k, const Least<Real>& given) { part[k] = smaller(part[k], given.value); }
    double result() const {
      Real out = part[0];
      for (int k = 1; k < kSize; ++k) out = smaller(out, part[k]);
      return static_cast<double>(out);
    }
  };
  [[gnu::always_inline]] Apart apart() const {
    Apart out;
    all_.store(out.part);
    return out;
  }

 private:
  Vector<Real, kSize> all_{std::numeric_limits<Real>::infinity()};
};

template <class Real, int kSize>
class Reduction<Largest<Vector<Real, kSize>>> {
 public:
  using Result = double;
  [[gnu::always_inline]] void add(const Largest<Vector<Real, kSize>>& given) {
    all_ = larger(all_, given.value);
  }
  struct Apart {
    Real part[kSize];
    void add(std::size_t k, const Largest<Real>& given) { part[k] = larger(part[k], given.value); }
    double result() const {
      Real out = part[0];
      for (int k = 1; k < kSize; ++k) out = larger(out, part[k]);
      return static_cast<double>(out);
    }
  };
  [[gnu::always_inline]] Apart apart() const {
    Apart out;
    all_.store(out.part);
    return out;
  }

 private:
  Vector<Real, kSize> all_{-std::numeric_limits<Real>::infinity()};
};

template <class Value, std::size_t kCount>
class Reduction<std::array<Value, kCount>> {
 public:
  using Result = std::array<typename Reduction<Value>::Result, kCount>;
  [[gnu::always_inline]] void add(const std::array<Value, kCount>& values) {
    unrolled<kCount>([&](auto i) __attribute__((always_inline)) { all_[i].add(values[i]); });
  }
  struct Apart {
    std::array<typename Reduction<Value>::Apart, kCount> all;
    template <class Given>
    void add(std::size_t k, const std::array<Given, kCount>& values) {
      for (std::size_t i = 0; i < kCount; ++i) all[i].add(k, values[i]);
    }
    Result result() const {
      Result out;
      for (std::size_t i = 0; i < kCount; ++i) out[i] = all[i].result();
      return out;
    }
  };
  [[gnu::always_inline]] Apart apart() const {
    Apart out;
    for (std::size_t i = 0; i < kCount; ++i) out.all[i] = all_[i].apart();
    return out;
  }

 private:
  std::array<Reduction<Value>, kCount> all_;
};

template <class... Values>
class Reduction<std::tuple<Values...>> {
 public:
  using Result = std::tuple<typename Reduction<Values>::Result...>;
  [[gnu::always_inline]] void add(const std::tuple<Values...>& values) {
    unrolled<sizeof...(Values)>([&](auto i) __attribute__((always_inline)) {
      std::get<i>(all_).add(std::get<i>(values));
    });
  }
  struct Apart {
    std::tuple<typename Reduction<Values>::Apart...> all;
    template <class... Given>
    void add(std::size_t k, const std::tuple<Given...>& values) {
      unrolled<sizeof...(Values)>([&](auto i) { std::get<i>(all).add(k, std::get<i>(values)); });
    }
    Result result() const {
      return std::apply([](const auto&... one) { return Result(one.result()...); }, all);
    }
  };
  [[gnu::always_inline]] Apart apart() const {
    return std::apply([](const auto&... one) { return Apart{{one.apart()...}}; }, all_);
  }

 private:
  std::tuple<Reduction<Values>...> all_;
};

// The values that kernel(Pixels) gives for each pixel of [begin, end) together: sums of numbers,
// the least of Least, the largest of Largest; of a tuple or an array each member for itself. Of no
// pixel: 0, infinity, -infinity.
template <class Real = double, class Kernel>
[[gnu::always_inline]] inline auto reduce(std::size_t begin, std::size_t end,
                                          const Kernel& kernel) {
  using V = Vector<Real>;
  Reduction<std::decay_t<std::invoke_result_t<Kernel, Pixels<V>>>> all;
  std::size_t i = begin;
  if (!PixelByPixel::asked()) {
    for (; i + V::kSize <= end; i += V::kSize) all.add(kernel(Pixels<V>(i)));
  }
  auto apart = all.apart();
  for (; i < end; ++i) apart.add((i - begin) % V::kSize, kernel(Pixels<Real>(i)));
  return apart.result();
}
template <class Real = double, class Kernel>
[[gnu::always_inline]] inline auto reduce(std::size_t n, const Kernel& kernel) {
  return reduce<Real>(0, n, kernel);
}
template <class Real = double, class Kernel>
[[gnu::always_inline]] inline double sum_over(std::size_t n, const Kernel& kernel) {
  return reduce<Real>(0, n, kernel);
}

// Where `mask` holds and holds(one number of each of values) does, asked for those numbers alone.
template <class Holds>
bool holds_for(bool mask, const Holds& holds, double a, double b) {
  return mask && holds(a, b);
}
template <class Real, int kSize, class Holds>
Mask<Real, kSize> holds_for(const Mask<Real, kSize>& mask, const Holds& holds,
                            const Vector<Real, kSize>& a, const Vector<Real, kSize>& b) {
  unsigned bits = mask.bits();
  if (bits == 0) return mask;
  Mask<Real, kSize> out = mask;
  for (; bits != 0; bits &= bits - 1) {
    const int k = __builtin_ctz(bits);
    if (!holds(a[k], b[k])) out.clear(k);
  }
  return out;
}

// visit(i), in ascending order, for the pixels of [begin, end) at which condition(Pixels) holds:
// few, or the loop over them is what takes the time.
template <class Condition, class Visit>
[[gnu::always_inline]] inline void for_each_where(std::size_t begin, std::size_t end,
                                                  const Condition& condition, const Visit& visit) {
  using V = Vector<double>;
  std::size_t i = begin;
  if (!PixelByPixel::asked()) {
    for (; i + V::kSize <= end; i += V::kSize) {
      for (unsigned bits = condition(Pixels<V>(i)).bits(); bits != 0; bits &= bits - 1)
        visit(i + static_cast<std::size_t>(__builtin_ctz(bits)));
    }
  }
  for (; i < end; ++i) {
    if (condition(Pixels<double>(i))) visit(i);
  }
}
template <class Condition, class Visit>
[[gnu::always_inline]] inline void for_each_where(std::size_t n, const Condition& condition,
                                                  const Visit& visit) {
  for_each_where(0, n, condition, visit);
}

}  // namespace papilla::numerics
