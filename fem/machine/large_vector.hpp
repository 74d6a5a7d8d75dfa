// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <new>
#include <utility>
#include <vector>

namespace dielast::fem {

/// Memory on large pages, where the system has some: fewer of them are to be made and to be looked up.
template<class T>
struct LargePages {
  using value_type = T;
  static constexpr std::align_val_t page{std::size_t{1} << 21};

  LargePages() = default;
  template<class Other>
  explicit LargePages(const LargePages<Other>&) {}

  T* allocate(std::size_t count) {
    const std::size_t bytes = count * sizeof(T);
    if (bytes < 2 * static_cast<std::size_t>(page)) return static_cast<T*>(::operator new(bytes));
    void* const memory = ::operator new(bytes, page);
    madvise(memory, bytes, MADV_HUGEPAGE);
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t count) {
    if (count * sizeof(T) < 2 * static_cast<std::size_t>(page))
      ::operator delete(memory);
    else
      ::operator delete(memory, page);
  }
  /// Numbers without a value are not written.
  template<class U>
  void construct(U* place) {
    ::new (static_cast<void*>(place)) U;
  }
  template<class U, class... Values>
  void construct(U* place, Values&&... values) {
    ::new (static_cast<void*>(place)) U(std::forward<Values>(values)...);
  }
  bool operator==(const LargePages&) const = default;
};

/// Numbers that are anything until they are written.
template<class T>
using LargeVector = std::vector<T, LargePages<T>>;

} // namespace dielast::fem
