// Numbers side by side: as many as 64 bytes hold, in as few registers as the machine has for them,
// so that sums are the same on every machine. What is written with these operators and functions
// for a type T compiles for one number, T = double, and for several, T = Vector<double>. The only
// header that knows a register.
#pragma once

#if defined(__SSE2__)
#include <immintrin.h>
#endif

#include <cmath>
#include <cstddef>
#include <cstring>
#include <type_traits>
#include <utility>

#include "base/rooms.h"

namespace papilla::numerics {

#if defined(__AVX512F__) && defined(__AVX512DQ__)
inline constexpr int kRegisterBytes = 64;
#elif defined(__AVX__)
inline constexpr int kRegisterBytes = 32;
#else
inline constexpr int kRegisterBytes = 16;
#endif

// kCount numbers that the compiler computes with as with one.
template <class T, int kCount>
struct Packed {
  using Type __attribute__((vector_size(kCount * sizeof(T)))) = T;
  using Anywhere __attribute__((vector_size(kCount * sizeof(T)), aligned(alignof(T)))) = T;
};

// work(0), work(1), ... with the index as a constant: compilers keep an array in registers only
// where they know each index.
template <int kCount, class Work>
[[gnu::always_inline]] inline void unrolled(const Work& work) {
  [&]<int... k>(std::integer_sequence<int, k...>) __attribute__((always_inline)) {
    (work(std::integral_constant<int, k>()), ...);
  }
  (std::make_integer_sequence<int, kCount>());
}

template <class T, int kCount>
struct Vector;

// What a comparison of vectors gives, one answer for each number.
template <class T, int kCount>
struct Mask {
  using Values = Vector<T, kCount>;
  static constexpr int kParts = Values::kParts, kPartSize = Values::kPartSize;
  using Part = decltype(typename Values::Part{} < typename Values::Part{});

  [[gnu::always_inline]] bool operator[](int k) const {
    return part[k / kPartSize][k % kPartSize] != 0;
  }
  void clear(int k) { part[k / kPartSize][k % kPartSize] = 0; }
  // One bit for each number, the first one lowest.
  [[gnu::always_inline]] unsigned bits() const {
    unsigned out = 0;
    unrolled<kParts>([&](auto i) __attribute__((always_inline)) {
      out |= bits_of(part[i]) << (i * kPartSize);
    });
    return out;
  }

  // 1 where it holds, 0 elsewhere.
  template <class To>
  [[gnu::always_inline]] void store(To* to) const {
    using Target = typename Packed<To, kPartSize>::Anywhere;
    unrolled<kParts>([&](auto i) __attribute__((always_inline)) {
      *reinterpret_cast<Target*>(to + i * kPartSize) = __builtin_convertvector(part[i], Target) & 1;
    });
  }

  [[gnu::always_inline]] friend Mask operator&&(const Mask& a, const Mask& b) {
    Mask out;
    unrolled<kParts>([&](auto i)
                         __attribute__((always_inline)) { out.part[i] = a.part[i] & b.part[i]; });
    return out;
  }
  [[gnu::always_inline]] friend Mask operator||(const Mask& a, const Mask& b) {
    Mask out;
    unrolled<kParts>([&](auto i)
                         __attribute__((always_inline)) { out.part[i] = a.part[i] | b.part[i]; });
    return out;
  }
  [[gnu::always_inline]] friend Mask operator!(const Mask& a) {
    Mask out;
    unrolled<kParts>([&](auto i) __attribute__((always_inline)) { out.part[i] = ~a.part[i]; });
    return out;
  }

  // By bits: compilers make branches of `?` with a mask put together from others.
  [[gnu::always_inline]] friend Values chosen(const Mask& where, const Values& then,
                                              const Values& otherwise) {
    Values out;
    unrolled<kParts>([&](auto i) __attribute__((always_inline)) {
      Part a, b;
      std::memcpy(&a, &then.part[i], sizeof a);
      std::memcpy(&b, &otherwise.part[i], sizeof b);
      const Part bits = (a & where.part[i]) | (b & ~where.part[i]);
      std::memcpy(&out.part[i], &bits, sizeof bits);
    });
    return out;
  }
  [[gnu::always_inline]] friend Mask chosen(const Mask& where, const Mask& then,
                                            const Mask& otherwise) {
    return (where && then) || (!where && otherwise);
  }
  [[gnu::always_inline]] friend bool any(const Mask& mask) { return mask.bits() != 0; }

  [[gnu::always_inline]] static unsigned bits_of(const Part& part) {
    [[maybe_unused]] constexpr bool wide = sizeof(T) == 8;
#if defined(__AVX512F__) && defined(__AVX512DQ__)
    if constexpr (sizeof part == 64) {
      const auto v = reinterpret_cast<const __m512i&>(part);
      return wide ? _mm512_movepi64_mask(v) : _mm512_movepi32_mask(v);
    }
#endif
#if defined(__AVX__)
    if constexpr (sizeof part == 32) {
      return static_cast<unsigned>(wide
                                       ? _mm256_movemask_pd(reinterpret_cast<const __m256d&>(part))
                                       : _mm256_movemask_ps(reinterpret_cast<const __m256&>(part)));
    }
#endif
#if defined(__SSE2__)
    if constexpr (sizeof part == 16) {
      return static_cast<unsigned>(wide ? _mm_movemask_pd(reinterpret_cast<const __m128d&>(part))
                                        : _mm_movemask_ps(reinterpret_cast<const __m128&>(part)));
    }
#endif
    unsigned out = 0;
    for (int k = 0; k < kPartSize; ++k) out |= (part[k] != 0 ? 1u : 0u) << k;
    return out;
  }

  Part part[kParts];
};

template <class T, int kCount = 64 / sizeof(T)>
struct Vector {
  using Number = T;
  static constexpr int kSize = kCount, kParts = 64 / kRegisterBytes, kPartSize = kCount / kParts;
  using Part = typename Packed<T, kPartSize>::Type;

  Vector() = default;
  [[gnu::always_inline]] Vector(T value) {  // every one of them
    unrolled<kParts>([&](auto i) __attribute__((always_inline)) { part[i] = Part{} + value; });
  }
  // From the numbers at `from` on, which may be of another type.
  template <class From>
  [[gnu::always_inline]] static Vector load(const From* from) {
    using Source = typename Packed<From, kPartSize>::Anywhere;
    Vector out;
    unrolled<kParts>([&](auto i) __attribute__((always_inline)) {
      const Source& source = *reinterpret_cast<const Source*>(from + i * kPartSize);
      if constexpr (std::is_same_v<From, T>) {
        out.part[i] = source;
      } else if constexpr (sizeof(From) == 1) {  // by way of int, for which there is an instruction
        using Wider = typename Packed<int, kPartSize>::Type;
        out.part[i] = __builtin_convertvector(__builtin_convertvector(source, Wider), Part);
      } else {
        out.part[i] = __builtin_convertvector(source, Part);
      }
    });
    return out;
  }
  template <class To>
  [[gnu::always_inline]] void store(To* to) const {
    using Target = typename Packed<To, kPartSize>::Anywhere;
    unrolled<kParts>([&](auto i) __attribute__((always_inline)) {
      Target& target = *reinterpret_cast<Target*>(to + i * kPartSize);
      if constexpr (std::is_same_v<To, T>) {
        target = part[i];
      } else {
        target = __builtin_convertvector(part[i], Target);
      }
    });
  }

  [[gnu::always_inline]] T operator[](int k) const { return part[k / kPartSize][k % kPartSize]; }

#define PAPILLA_OF_EACH(op)                                                            \
  [[gnu::always_inline]] friend Vector operator op(const Vector& a, const Vector& b) { \
    Vector out;                                                                        \
    unrolled<kParts>([&](auto i) __attribute__((always_inline)) {                      \
      out.part[i] = a.part[i] op b.part[i];                                            \
    });                                                                                \
    return out;                                                                        \
  }                                                                                    \
  [[gnu::always_inline]] Vector& operator op##=(const Vector& b) { return *this = *this op b; }
  PAPILLA_OF_EACH(+)
  PAPILLA_OF_EACH(-)
  PAPILLA_OF_EACH(*)
  PAPILLA_OF_EACH(/)
#undef PAPILLA_OF_EACH
#define PAPILLA_OF_EACH(op)                                                                     \
  [[gnu::always_inline]] friend Mask<T, kCount> operator op(const Vector& a, const Vector& b) { \
    Mask<T, kCount> out;                                                                        \
    unrolled<kParts>([&](auto i) __attribute__((always_inline)) {                               \
      out.part[i] = a.part[i] op b.part[i];                                                     \
    });                                                                                         \
    return out;                                                                                 \
  }
  PAPILLA_OF_EACH(<)
  PAPILLA_OF_EACH(>)
  PAPILLA_OF_EACH(<=)
  PAPILLA_OF_EACH(>=)
  PAPILLA_OF_EACH(==)
  PAPILLA_OF_EACH(!=)
#undef PAPILLA_OF_EACH
  [[gnu::always_inline]] friend Vector operator-(const Vector& a) {
    Vector out;
    unrolled<kParts>([&](auto i) __attribute__((always_inline)) { out.part[i] = -a.part[i]; });
    return out;
  }

  [[gnu::always_inline]] friend Vector smaller(const Vector& a, const Vector& b) {
    Vector out;
    unrolled<kParts>([&](auto i) __attribute__((always_inline)) {
      out.part[i] = a.part[i] < b.part[i] ? a.part[i] : b.part[i];
    });
    return out;
  }
  [[gnu::always_inline]] friend Vector larger(const Vector& a, const Vector& b) {
    Vector out;
    unrolled<kParts>([&](auto i) __attribute__((always_inline)) {
      out.part[i] = a.part[i] > b.part[i] ? a.part[i] : b.part[i];
    });
    return out;
  }
  [[gnu::always_inline]] friend Vector root(const Vector& a) {
    Vector out;
    unrolled<kParts>([&](auto i)
                         __attribute__((always_inline)) { out.part[i] = root_of(a.part[i]); });
    return out;
  }

  // Of its numbers: by halves, each the larger of two.
  [[gnu::always_inline]] friend T largest_of(const Vector& a) {
    Part all = a.part[0];
    unrolled<kParts>([&](auto i) __attribute__((always_inline)) {
      all = all > a.part[i] ? all : a.part[i];
    });
    return largest_in<kPartSize>(all);
  }

  // values[at[k]]
  [[gnu::always_inline]] static Vector gather(const T* values, const Vector<int, kCount>& at) {
    Vector out;
    unrolled<kParts>([&](auto i) __attribute__((always_inline)) {
      for (int k = 0; k < kPartSize; ++k)
        out.part[i][k] = values[static_cast<unsigned>(at.part[i][k])];
    });
    return out;
  }
  // The same, and the values after them.
  [[gnu::always_inline]] static std::pair<Vector, Vector> gather_pairs(
      const T* values, const Vector<int, kCount>& at) {
    std::pair<Vector, Vector> out;
    unrolled<kParts>([&](auto i) __attribute__((always_inline)) {
      const auto pair = [&](int k) __attribute__((always_inline)) {
        using Two = typename Packed<T, 2>::Anywhere;
        return typename Packed<T, 2>::Type(
            *reinterpret_cast<const Two*>(values + static_cast<unsigned>(at.part[i][k])));
      };
      if constexpr (kPartSize == 8) {
        const auto a = joined(joined(pair(0), pair(2)), joined(pair(4), pair(6))),
                   b = joined(joined(pair(1), pair(3)), joined(pair(5), pair(7)));
        out.first.part[i] = __builtin_shufflevector(a, b, 0, 8, 2, 10, 4, 12, 6, 14);
        out.second.part[i] = __builtin_shufflevector(a, b, 1, 9, 3, 11, 5, 13, 7, 15);
      } else if constexpr (kPartSize == 4) {
        const auto a = joined(pair(0), pair(2)), b = joined(pair(1), pair(3));
        out.first.part[i] = __builtin_shufflevector(a, b, 0, 4, 2, 6);
        out.second.part[i] = __builtin_shufflevector(a, b, 1, 5, 3, 7);
      } else {
        static_assert(kPartSize == 2);
        const auto a = pair(0), b = pair(1);
        out.first.part[i] = __builtin_shufflevector(a, b, 0, 2);
        out.second.part[i] = __builtin_shufflevector(a, b, 1, 3);
      }
    });
    return out;
  }

  template <int kLeft, class V>
  [[gnu::always_inline]] static T largest_in(const V& v) {
    if constexpr (kLeft == 2) {
      return v[0] > v[1] ? v[0] : v[1];
    } else {
      typename Packed<T, kLeft / 2>::Type low, high;
      std::memcpy(&low, &v, sizeof low);
      std::memcpy(&high, reinterpret_cast<const char*>(&v) + sizeof low, sizeof high);
      return largest_in<kLeft / 2>(low > high ? low : high);
    }
  }
  [[gnu::always_inline]] static Part root_of(const Part& a) {
    [[maybe_unused]] constexpr bool wide = sizeof(T) == 8;
#if defined(__AVX512F__) && defined(__AVX512DQ__)
    // With a mask of ones: g++ 12 takes what stands beside no mask for an unset value.
    if constexpr (sizeof a == 64 && wide)
      return Part(_mm512_mask_sqrt_pd(__m512d(a), 0xff, __m512d(a)));
    if constexpr (sizeof a == 64 && !wide)
      return Part(_mm512_mask_sqrt_ps(__m512(a), 0xffff, __m512(a)));
#elif defined(__AVX__)
    if constexpr (sizeof a == 32 && wide) return Part(_mm256_sqrt_pd(__m256d(a)));
    if constexpr (sizeof a == 32 && !wide) return Part(_mm256_sqrt_ps(__m256(a)));
#else
    Part out;
    for (int k = 0; k < kPartSize; ++k) out[k] = std::sqrt(a[k]);
    return out;
#endif
  }

  template <class V>
  [[gnu::always_inline]] static auto joined(const V& a, const V& b) {
    if constexpr (sizeof a == 2 * sizeof(T)) {
      return __builtin_shufflevector(a, b, 0, 1, 2, 3);
    } else {
      return __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7);
    }
  }

  Part part[kParts];
};

// The integers that stand beside numbers of type T: indices of arrays.
template <class T>
struct IndexBeside {
  using Type = int;
};
template <class T, int kCount>
struct IndexBeside<Vector<T, kCount>> {
  using Type = Vector<int, kCount>;
};
template <class T>
using IndexOf = typename IndexBeside<T>::Type;

template <int kCount>
[[gnu::always_inline]] inline Vector<double, kCount> as_number(const Vector<int, kCount>& i) {
  Vector<double, kCount> out;
  unrolled<out.kParts>([&](auto k) __attribute__((always_inline)) {
    out.part[k] = __builtin_convertvector(i.part[k], typename Vector<double, kCount>::Part);
  });
  return out;
}
// Towards zero.
template <int kCount>
[[gnu::always_inline]] inline Vector<int, kCount> truncated(const Vector<double, kCount>& a) {
  Vector<int, kCount> out;
  unrolled<out.kParts>([&](auto k) __attribute__((always_inline)) {
    out.part[k] = __builtin_convertvector(a.part[k], typename Vector<int, kCount>::Part);
  });
  return out;
}
// Downwards.
template <int kCount>
[[gnu::always_inline]] inline Vector<int, kCount> floored(const Vector<double, kCount>& a) {
  Vector<int, kCount> out;
  using Index = typename Vector<int, kCount>::Part;
  unrolled<out.kParts>([&](auto k) __attribute__((always_inline)) {
    const Index cut = __builtin_convertvector(a.part[k], Index);
    const auto back = __builtin_convertvector(cut, typename Vector<double, kCount>::Part);
    out.part[k] = cut + __builtin_convertvector(a.part[k] < back, Index);  // -1 where it is so
  });
  return out;
}
template <int kCount>
[[gnu::always_inline]] inline Vector<double, kCount> values_at(const double* values,
                                                               const Vector<int, kCount>& at) {
  return Vector<double, kCount>::gather(values, at);
}
// The values there and those after them.
template <int kCount>
[[gnu::always_inline]] inline std::pair<Vector<double, kCount>, Vector<double, kCount>> pairs_at(
    const double* values, const Vector<int, kCount>& at) {
  return Vector<double, kCount>::gather_pairs(values, at);
}

// The same of one number.
inline double chosen(bool where, double then, double otherwise) { return where ? then : otherwise; }
inline float chosen(bool where, float then, float otherwise) { return where ? then : otherwise; }
inline int chosen(bool where, int then, int otherwise) { return where ? then : otherwise; }
inline bool chosen(bool where, bool then, bool otherwise) { return where ? then : otherwise; }
inline bool any(bool value) { return value; }
inline double smaller(double a, double b) { return a < b ? a : b; }
inline float smaller(float a, float b) { return a < b ? a : b; }
inline double larger(double a, double b) { return a > b ? a : b; }
inline float larger(float a, float b) { return a > b ? a : b; }
inline double root(double a) { return std::sqrt(a); }
inline float root(float a) { return std::sqrt(a); }
inline float largest_of(float a) { return a; }
inline double as_number(int i) { return i; }
inline int truncated(double a) { return static_cast<int>(a); }
inline int floored(double a) { return static_cast<int>(a) - (a < static_cast<int>(a) ? 1 : 0); }
inline double values_at(const double* values, int at) { return values[at]; }
inline std::pair<double, double> pairs_at(const double* values, int at) {
  return {values[at], values[at + 1]};
}

}  // namespace papilla::numerics
