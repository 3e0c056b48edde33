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
  // A thread that comes late, since the machine had other things to do, finds that all was taken and keeps nobody waiting. What it read of
  // a round counts only if the ticket still was of that round when it took a piece: then no other round can begin before that is done.
  void take_pieces(std::uint32_t of_round) {
    while (true) {
      std::uint64_t taken = ticket.load(std::memory_order_acquire);
      const auto piece = static_cast<std::size_t>(taken & kPieceMask);
      const std::size_t all = count.load(std::memory_order_acquire);
      void* const with = context.load(std::memory_order_acquire);
      const Call work_on = call.load(std::memory_order_acquire);
      if (taken >> kRoundShift != of_round || piece >= all) return;
      if (!ticket.compare_exchange_weak(taken, taken + 1, std::memory_order_acq_rel)) continue;
      work_on(with, piece);
      if (done.fetch_add(1, std::memory_order_acq_rel) + 1 == all) done.notify_one();
    }
  }

  void work() {
    std::uint32_t seen = 0;
    while (true) {
      await_change(round, seen);
      seen = round.load(std::memory_order_acquire);
      if (ending.load(std::memory_order_acquire)) return;
      take_pieces(seen);
    }
  }

  static constexpr int kRoundShift = 32;
  static constexpr std::uint64_t kPieceMask = 0xFFFFFFFF;

  // What a round is about.
  std::atomic<std::size_t> count = 0;
  std::atomic<void*> context = nullptr;
  std::atomic<Call> call = nullptr;
  std::atomic<bool> ending = false;
  // Each on its own cache line: everybody looks at them.
  alignas(64) std::atomic<std::uint32_t> round = 0;
  alignas(64) std::atomic<std::uint64_t> ticket = 0;  // The round, and in the lower half its next piece.
  alignas(64) std::atomic<std::size_t> done = 0;
  std::vector<std::thread> threads;
};

Crew::Crew(int size) : size_(std::max(size, 1)) {
  if (size_ == 1) return;
  shared_ = std::make_unique<Shared>();
  for (int i = 1; i < size_; ++i) shared_->threads.emplace_back([shared = shared_.get()] { shared->work(); });
}

Crew::~Crew() {
  if (shared_ == nullptr) return;
  shared_->ending.store(true, std::memory_order_release);
  shared_->round.fetch_add(1, std::memory_order_release);
  shared_->round.notify_all();
  for (std::thread& thread : shared_->threads) thread.join();
}

void Crew::share(std::size_t count, void* context, Call call) {
  Shared& shared = *shared_;
  // First the ticket is closed: who has seen the one of the round before must not take a piece of it with what this round is about.
  const std::uint32_t round = shared.round.load(std::memory_order_relaxed) + 1;
  shared.ticket.store(std::uint64_t{round} << Shared::kRoundShift | Shared::kPieceMask, std::memory_order_relaxed);
  shared.count.store(count, std::memory_order_release);
  shared.context.store(context, std::memory_order_release);
  shared.call.store(call, std::memory_order_release);
  shared.done.store(0, std::memory_order_relaxed);
  shared.ticket.store(std::uint64_t{round} << Shared::kRoundShift, std::memory_order_release);
  shared.round.store(round, std::memory_order_release);
  shared.round.notify_all();
  shared.take_pieces(round);
  for (std::size_t done = shared.done.load(std::memory_order_acquire); done != count; done = shared.done.load(std::memory_order_acquire)) {
    await_change(shared.done, done);
  }
}

}  // namespace topple

#endif
