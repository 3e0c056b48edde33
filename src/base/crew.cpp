#include "base/crew.h"

#if defined(__wasm__)  // the page runs it in a worker, which is one thread

namespace topple {

struct Crew::Shared {};
Crew::Crew(int) {}
Crew::~Crew() = default;
void Crew::share(std::size_t, void*, Call) {}

}  // namespace topple

#else

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

namespace topple {

namespace {

/// How often a thread looks before it sleeps: some 20 us, several times what waking it up would cost.
constexpr int kLooks = 4000;

void pause_briefly() {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#endif
}

/// Until `word` is no longer `old`.
template <class T>
void await_change(const std::atomic<T>& word, T old) {
  for (int look = 0; look < kLooks; ++look) {
    if (word.load(std::memory_order_acquire) != old) return;
    pause_briefly();
  }
  while (word.load(std::memory_order_acquire) == old) word.wait(old, std::memory_order_acquire);
}

}  // namespace

struct Crew::Shared {
  void take_pieces() {
    for (std::size_t i = next.fetch_add(1, std::memory_order_relaxed); i < count; i = next.fetch_add(1, std::memory_order_relaxed)) {
      call(context, i);
    }
  }

  void work() {
    std::uint32_t seen = 0;
    while (true) {
      await_change(round, seen);
      ++seen;
      if (ending) return;
      take_pieces();
      if (busy.fetch_sub(1, std::memory_order_acq_rel) == 1) busy.notify_one();
    }
  }

  // What a round is about; written before `round` grows, read after.
  std::size_t count = 0;
  void* context = nullptr;
  Call call = nullptr;
  bool ending = false;
  // Each on its own cache line: everybody looks at them.
  alignas(64) std::atomic<std::uint32_t> round = 0;
  alignas(64) std::atomic<std::size_t> next = 0;
  alignas(64) std::atomic<int> busy = 0;
  std::vector<std::thread> threads;
};

Crew::Crew(int size) : size_(std::max(size, 1)) {
  if (size_ == 1) return;
  shared_ = std::make_unique<Shared>();
  for (int i = 1; i < size_; ++i) shared_->threads.emplace_back([shared = shared_.get()] { shared->work(); });
}

Crew::~Crew() {
  if (shared_ == nullptr) return;
  shared_->ending = true;
  shared_->round.fetch_add(1, std::memory_order_release);
  shared_->round.notify_all();
  for (std::thread& thread : shared_->threads) thread.join();
}

void Crew::share(std::size_t count, void* context, Call call) {
  Shared& shared = *shared_;
  shared.count = count;
  shared.context = context;
  shared.call = call;
  shared.next.store(0, std::memory_order_relaxed);
  shared.busy.store(size_ - 1, std::memory_order_relaxed);
  shared.round.fetch_add(1, std::memory_order_release);
  shared.round.notify_all();
  shared.take_pieces();
  for (int left = shared.busy.load(std::memory_order_acquire); left != 0; left = shared.busy.load(std::memory_order_acquire)) {
    await_change(shared.busy, left);
  }
}

}  // namespace topple

#endif
