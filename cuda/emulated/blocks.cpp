// Blocks of threads of the emulated device.
#include <atomic>
#include <boost/context/fiber.hpp>
#include <boost/context/protected_fixedsize_stack.hpp>
#include <cstdint>
#include <cstdlib>
#include <exception>
#include <memory>
#include <numeric>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/parallel.h"
#include "cuda/emulated/launch.h"

namespace rangepose::cuda::emulated {
namespace {

namespace context = boost::context;

constexpr std::size_t kStackBytes = 256 * 1024;
constexpr unsigned kMostThreads = 1024;

unsigned seedOfEnvironment() {
  const char* text = std::getenv("RP_CUDA_SHUFFLE");
  return text == nullptr ? 0 : static_cast<unsigned>(std::strtoul(text, nullptr, 10));
}

std::atomic<unsigned>& shuffleSeed() {
  static std::atomic<unsigned> seed{seedOfEnvironment()};
  return seed;
}

/// SplitMix64 (Steele, Lea, Flood 2014).
std::uint64_t mixed(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

/// 0, 1, ... in an order of its own for each seed; as they are for seed 0.
std::vector<unsigned> orderOf(unsigned count, unsigned seed, std::uint64_t salt) {
  std::vector<unsigned> order(count);
  std::iota(order.begin(), order.end(), 0U);
  if (seed == 0) return order;
  for (unsigned i = count; i > 1; --i) {
    const std::uint64_t draw = mixed(mixed(seed + (salt << 32U)) + i);
    std::swap(order[i - 1], order[draw % i]);
  }
  return order;
}

dim3 indexIn(const dim3& size, unsigned number) {
  return {number % size.x, number / size.x % size.y, number / size.x / size.y};
}

class BlockRunner;
thread_local BlockRunner* running = nullptr;

/// The threads of one block after the other, on one thread of the host.
class BlockRunner {
 public:
  void run(const dim3& threads, const std::function<void()>& kernel, unsigned seed) {
    kernel_ = &kernel;
    failure_ = nullptr;
    BlockRunner* const outer = std::exchange(running, this);
    const std::uint64_t block = blockIdx.x + (static_cast<std::uint64_t>(blockIdx.y) << 20U) +
                                (static_cast<std::uint64_t>(blockIdx.z) << 40U);
    std::vector<Strand*> waiting;
    for (const unsigned thread : orderOf(threads.x * threads.y * threads.z, seed, block)) {
      Strand& strand = freeStrand();
      strand.thread = indexIn(threads, thread);
      resume(strand, waiting);
    }
    for (std::uint64_t phase = 1; !waiting.empty(); ++phase) {
      counted_ = 0;
      for (const Strand* strand : waiting) counted_ += strand->predicate ? 1 : 0;
      const std::vector<Strand*> met = std::exchange(waiting, {});
      for (const unsigned i :
           orderOf(static_cast<unsigned>(met.size()), seed, block + (phase << 50U)))
        resume(*met[i], waiting);
    }
    running = outer;
    if (failure_) std::rethrow_exception(failure_);
  }

  /// Of the strand that runs: waits for all others of its block, and tells how many of them have a
  /// predicate that holds.
  int meet(bool predicate) {
    Strand& strand = *current_;
    strand.predicate = predicate;
    strand.waits = true;
    strand.runner = std::move(strand.runner).resume();
    return counted_;
  }

 private:
  struct Strand {
    context::fiber own;     ///< while it does not run
    context::fiber runner;  ///< while it does
    dim3 thread;
    bool waits = false;
    bool predicate = false;
  };

  Strand& freeStrand() {
    if (!free_.empty()) {
      Strand* strand = free_.back();
      free_.pop_back();
      return *strand;
    }
    Strand& strand = *strands_.emplace_back(std::make_unique<Strand>());
    strand.own = context::fiber(std::allocator_arg,
                                context::protected_fixedsize_stack(kStackBytes),
                                [&](context::fiber&& to) {
                                  strand.runner = std::move(to);
                                  for (;;) {
                                    try {
                                      (*kernel_)();
                                    } catch (const Error&) {
                                      if (!failure_) failure_ = std::current_exception();
                                    }
                                    strand.waits = false;
                                    strand.runner = std::move(strand.runner).resume();
                                  }
                                  return std::move(strand.runner);
                                });
    return strand;
  }

  void resume(Strand& strand, std::vector<Strand*>& waiting) {
    current_ = &strand;
    threadIdx = strand.thread;
    strand.own = std::move(strand.own).resume();
    if (strand.waits) {
      waiting.push_back(&strand);
    } else {
      free_.push_back(&strand);
    }
  }

  std::vector<std::unique_ptr<Strand>> strands_;
  std::vector<Strand*> free_;
  Strand* current_ = nullptr;
  const std::function<void()>* kernel_ = nullptr;
  std::exception_ptr failure_;
  int counted_ = 0;
};

}  // namespace

void runBlocks(const dim3& blocks, const dim3& threads, const std::function<void()>& kernel) {
  const unsigned seed = shuffleSeed();
  const std::vector<unsigned> order = orderOf(blocks.x * blocks.y * blocks.z, seed, 7);
  RP_CHECK(threads.x * threads.y * threads.z <= kMostThreads, "a block has 1024 threads at most");
  parallelForEach(order.size(), 16, [&](std::size_t i) {
    static thread_local BlockRunner runner;
    gridDim = blocks;
    blockDim = threads;
    blockIdx = indexIn(blocks, order[i]);
    runner.run(threads, kernel, seed);
  });
}

void setShuffle(unsigned seed) { shuffleSeed() = seed; }

void failKernel(const char* what) { throw Error(what); }

int meetOthers(bool predicate) {
  if (running == nullptr) failKernel("a barrier outside of a kernel");
  return running->meet(predicate);
}

}  // namespace rangepose::cuda::emulated

void __syncthreads() { static_cast<void>(rangepose::cuda::emulated::meetOthers(false)); }
int __syncthreads_count(int predicate) {
  return rangepose::cuda::emulated::meetOthers(predicate != 0);
}
