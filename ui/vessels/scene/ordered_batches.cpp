#include "ui/vessels/scene/ordered_batches.h"

#include <algorithm>

namespace octascope::ui {

namespace {

constexpr std::size_t most_calls = 64; // that can wait for a helper that was held up
constexpr std::uint32_t longest_lead = 64;
constexpr std::uint32_t patience = 32; // batches in time before the helper works less far ahead

pipeline::ThreadSetup as_vessels(const pipeline::ThreadSetup& setup) {
  if (!setup)
    return {};
  return [setup](pipeline::ThreadRole role) { setup({"vessels", role.number}); };
}

} // namespace

OrderedBatches::OrderedBatches(std::uint32_t slots, const pipeline::ThreadSetup& setup)
    : slots_{slots},
      claims_(most_batches), helper_{1, most_calls, as_vessels(setup),
                                     [this](std::size_t, std::uint32_t turn) { help(turn); }} {}

void OrderedBatches::begin(std::uint32_t batches, Expand expand, const void* work) {
  if (++turns_ == 0)
    ++turns_;
  expand_ = expand;
  work_ = work;
  cursor_.store(0, std::memory_order_relaxed);
  turn_.store(turns_, std::memory_order_relaxed);
  for (std::uint32_t batch = 0; batch < batches; ++batch)
    claims_[batch].store(stamped(turns_, State::free), std::memory_order_release);
  if (batches > lead_.load(std::memory_order_relaxed))
    helper_.submit(turns_);
}

bool OrderedBatches::claim(std::uint32_t batch) {
  cursor_.store(batch, std::memory_order_relaxed);
  std::uint64_t expected = stamped(turns_, State::free);
  return claims_[batch].compare_exchange_strong(expected, stamped(turns_, State::callers),
                                                std::memory_order_acq_rel);
}

std::uint32_t OrderedBatches::await(std::uint32_t batch) {
  const auto is_ready = [this](std::uint64_t claim) {
    return static_cast<State>(claim & 0xFFU) == State::ready;
  };
  std::uint64_t claim = claims_[batch].load(std::memory_order_acquire);
  const std::uint32_t lead = lead_.load(std::memory_order_relaxed);
  if (!is_ready(claim)) {
    lead_.store(std::min(lead + 1, longest_lead), std::memory_order_relaxed);
    in_time_ = 0;
  } else if (++in_time_ == patience) {
    lead_.store(std::max(lead - 1, 1U), std::memory_order_relaxed);
    in_time_ = 0;
  }
  while (!is_ready(claim)) {
    batch_ready_.wait(); // of this one or of one before
    claim = claims_[batch].load(std::memory_order_acquire);
  }
  return static_cast<std::uint32_t>(claim >> 8U) & 0xFFFFFFU;
}

void OrderedBatches::release() {
  released_.fetch_add(1, std::memory_order_release);
  slot_released_.post();
}

void OrderedBatches::end() {
  turn_.store(0, std::memory_order_release);
  slot_released_.post();
}

bool OrderedBatches::await_slot(std::uint32_t turn) {
  while (filled_ - released_.load(std::memory_order_acquire) == slots_) {
    if (turn_.load(std::memory_order_acquire) != turn)
      return false;
    slot_released_.wait();
  }
  return true;
}

void OrderedBatches::help(std::uint32_t turn) {
  std::uint32_t batch = 0;
  while (await_slot(turn)) {
    batch = std::max(batch, cursor_.load(std::memory_order_relaxed) +
                                lead_.load(std::memory_order_relaxed));
    // What bears another turn's stamp is past the end, or this turn is over.
    for (;; ++batch) {
      if (batch >= most_batches)
        return;
      std::uint64_t claim = claims_[batch].load(std::memory_order_acquire);
      if (claim >> 32U != turn)
        return;
      if (claim == stamped(turn, State::free) &&
          claims_[batch].compare_exchange_strong(claim, stamped(turn, State::helpers),
                                                 std::memory_order_acq_rel))
        break;
    }
    const std::uint32_t slot = filled_++ % slots_;
    expand_(work_, batch, slot);
    claims_[batch].store(stamped(turn, State::ready, slot), std::memory_order_release);
    batch_ready_.post();
  }
}

} // namespace octascope::ui
