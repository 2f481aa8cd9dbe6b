// Shares out a range among threads.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <thread>
#include <vector>

namespace octascope::sim {

inline constexpr std::size_t chunk_size = 8192;

inline std::size_t chunks_of(std::size_t count) {
  return (count + chunk_size - 1) / chunk_size;
}

// Calls work(chunk, first, end) for each chunk of 0 … count − 1, on `threads` threads including this
// one, in any order. `work` does not throw.
template <class Work> void in_chunks(std::size_t count, std::size_t threads, const Work& work) {
  std::atomic<std::size_t> next = 0;
  const auto run = [&] {
    for (std::size_t chunk = 0; (chunk = next.fetch_add(1)) < chunks_of(count);)
      work(chunk, chunk * chunk_size, std::min(count, (chunk + 1) * chunk_size));
  };
  std::vector<std::jthread> others;
  for (std::size_t i = 1; i < std::min(threads, chunks_of(count)); ++i)
    others.emplace_back(run);
  run();
}

} // namespace octascope::sim
