#include "hal/linux/aravis/frame_slots.h"

#include <cstdlib>
#include <cstring>
#include <new>

namespace octascope::hal::linux_backend {

namespace {

constexpr std::size_t page = 4096;

} // namespace

void FrameSlots::Free::operator()(std::byte* memory) const {
  std::free(memory);
}

FrameSlots::FrameSlots(int count, std::size_t bytes)
    : bytes_{bytes}, stride_{(bytes + page - 1) / page * page},
      slots_(static_cast<std::size_t>(count)), ring_(static_cast<std::size_t>(count)) {
  const std::size_t all = stride_ * slots_.size();
  memory_.reset(static_cast<std::byte*>(std::aligned_alloc(page, all)));
  if (!memory_)
    throw std::bad_alloc{};
  std::memset(memory_.get(), 0, all);
}

bool FrameSlots::move(int slot, Place from, Place to) {
  return at(slot).place.compare_exchange_strong(from, to, std::memory_order_acq_rel);
}

bool FrameSlots::queue(int slot) {
  return move(slot, Place::idle, Place::queued);
}

void FrameSlots::serve(int slot, const ServedFrame& frame) {
  at(slot).frame = frame;
  at(slot).place.store(Place::waiting, std::memory_order_release);
  const std::size_t place = served_.load(std::memory_order_relaxed);
  ring_[place % ring_.size()] = slot;
  served_.store(place + 1, std::memory_order_release);
}

void FrameSlots::drop(int slot) {
  move(slot, Place::queued, Place::idle);
}

std::optional<int> FrameSlots::fetch() {
  const std::size_t place = fetched_.load(std::memory_order_relaxed);
  if (place == served_.load(std::memory_order_acquire))
    return std::nullopt;
  const int slot = ring_[place % ring_.size()];
  fetched_.store(place + 1, std::memory_order_release);
  at(slot).place.store(Place::lent, std::memory_order_release);
  return slot;
}

bool FrameSlots::give_back(int slot) {
  return slot >= 0 && slot < count() && move(slot, Place::lent, Place::idle);
}

void FrameSlots::reset() {
  for (int i = 0; i < count(); ++i)
    if (at(i).place.load(std::memory_order_acquire) != Place::lent)
      at(i).place.store(Place::idle, std::memory_order_release);
  fetched_.store(served_.load(std::memory_order_acquire), std::memory_order_release);
}

} // namespace octascope::hal::linux_backend
