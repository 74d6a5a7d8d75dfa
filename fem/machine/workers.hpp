// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <thread>
#include <vector>

namespace dielast::fem {

/// The threads of a model: one for its owner, who waits for the others.
class Workers {
 public:
  /// `threads`: 0 uses every core.
  explicit Workers(int threads)
      : count_(threads > 0 ? threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency()))),
        arena_(count_) {}

  int count() const { return count_; }

  /// f(0) ... f(count - 1), in any order. May be called by such an f.
  template<class Function>
  void run(std::size_t count, const Function& f) {
    if (count_ == 1 || count < 2) {
      for (std::size_t i = 0; i < count; ++i) f(i);
      return;
    }
#ifdef DIELAST_PLAIN_THREADS // the thread sanitizer does not see how TBB, which is not compiled with it,
                             // orders tasks
    const auto of_thread = [&](std::size_t first, std::size_t step) {
      for (std::size_t i = first; i < count; i += step) f(i);
    };
    const auto threads = static_cast<std::size_t>(count_);
    std::vector<std::thread> others;
    for (std::size_t t = 1; t < threads; ++t) others.emplace_back(of_thread, t, threads);
    of_thread(0, threads);
    for (std::thread& other : others) other.join();
#else
    arena_.execute([&] { tbb::parallel_for(std::size_t{0}, count, f); });
#endif
  }

  /// f(first, last) for ranges that make up 0 ... count-1, multiples of `size` but for the last, in any
  /// order.
  template<class Function>
  void run_blocks(int count, int size, const Function& f) {
    if (count_ == 1 || count <= size) {
      if (count > 0) f(0, count);
      return;
    }
    const int blocks = (count + size - 1) / size;
    run(static_cast<std::size_t>(blocks), [&](std::size_t block) {
      const int first = static_cast<int>(block) * size;
      f(first, std::min(first + size, count));
    });
  }

 private:
  int count_;
  tbb::task_arena arena_;
};

} // namespace dielast::fem
