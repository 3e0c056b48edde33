/// Threads that work side by side on independent pieces, for as long as their owner lives.
#pragma once

#include <cstddef>
#include <memory>
#include <type_traits>

namespace topple {

/// The caller and `size - 1` threads beside it. Where a platform has no threads, or the size is one, the caller does it all.
/// Between two calls the threads spin for some microseconds and then sleep, so that calls a step apart cost little.
class Crew {
 public:
  explicit Crew(int size);
  ~Crew();
  Crew(const Crew&) = delete;
  Crew& operator=(const Crew&) = delete;

  int size() const { return size_; }

  /// Calls work(i) once for each i from 0 to count - 1, in no particular order, and returns when all are done. The pieces must not touch
  /// what another one writes; then the result does not depend on the number of threads. Not to be called from within a piece.
  template <class Work>
  void each(std::size_t count, Work&& work) {
    if (size_ == 1 || count < 2) {
      for (std::size_t i = 0; i < count; ++i) work(i);
    } else {
      share(count, &work, [](void* context, std::size_t i) { (*static_cast<std::remove_reference_t<Work>*>(context))(i); });
    }
  }

 private:
  using Call = void (*)(void* context, std::size_t piece);
  struct Shared;
  void share(std::size_t count, void* context, Call call);

  int size_ = 1;
  std::unique_ptr<Shared> shared_;
};

}  // namespace topple
