#include "firmware-host/ledger/trace.h"

#include <algorithm>
#include <iterator>
#include <string>

#include <fmt/format.h>

#include "pipeline/files/atomic_file.h"

namespace octascope::firmware_host {

namespace {

// A row each, in this order from above. Those of the workers follow `first_worker`.
enum Row : std::uint32_t {
  camera = 1,
  hand_over,
  first_worker,
  fixed_rate = 900,
  waiting,
  render,
  glass
};

class EventText {
public:
  explicit EventText(hal::TimePoint started) : started_(started) {}

  void name_row(std::uint32_t row, std::string_view name) {
    add(R"({{"ph":"M","pid":1,"tid":{},"name":"thread_name","args":{{"name":"{}"}}}})", row, name);
    add(R"({{"ph":"M","pid":1,"tid":{0},"name":"thread_sort_index","args":{{"sort_index":{0}}}}})",
        row);
  }

  void event(std::uint32_t row, std::string_view name, std::uint64_t volume, hal::TimePoint begin,
             hal::TimePoint end) {
    add(R"({{"ph":"X","pid":1,"tid":{},"name":"{}","ts":{:.3f},"dur":{:.3f},"args":{{"volume":{}}}}})",
        row, name, microseconds(begin - started_), microseconds(std::max(end - begin, {})), volume);
  }

  std::string take() && { return text_ + "\n]}\n"; }

private:
  static double microseconds(hal::Duration duration) {
    return static_cast<double>(duration.count()) * 1e-3;
  }
  template <class... Values> void add(fmt::format_string<Values...> pattern, Values&&... values) {
    text_ += first_ ? "\n" : ",\n";
    first_ = false;
    fmt::format_to(std::back_inserter(text_), pattern, std::forward<Values>(values)...);
  }

  hal::TimePoint started_;
  std::string text_ = R"({"displayTimeUnit":"ms","traceEvents":[)";
  bool first_ = true;
};

void add_rows(EventText& text, std::uint32_t workers) {
  text.name_row(camera, "camera: exposure");
  text.name_row(hand_over, "camera thread: last frame");
  for (std::uint32_t worker = 0; worker < workers; ++worker)
    text.name_row(first_worker + worker, fmt::format("worker {}", worker + 1));
  text.name_row(fixed_rate, "fixed-rate thread");
  text.name_row(waiting, "triple buffer");
  text.name_row(render, "render thread");
  text.name_row(glass, "display");
}

void add_volume(EventText& text, const pipeline::VolumeMetadata& m, const Showing& showing) {
  text.event(camera, "exposure", m.index, m.first_line, m.last_line);
  text.event(hand_over, name_of(Stage::fetch), m.index, m.last_line, m.fetched);
  text.event(hand_over, name_of(Stage::queue), m.index, m.fetched, m.placed);
  text.event(fixed_rate, name_of(Stage::assemble), m.index, m.published - m.assemble, m.published);
  text.event(waiting, name_of(Stage::wait), m.index, m.published, showing.taken);
  text.event(render, name_of(Stage::upload), m.index, showing.taken, showing.uploaded);
  text.event(render, name_of(Stage::draw), m.index, showing.uploaded, showing.drawn);
  text.event(glass, name_of(Stage::flip), m.index, showing.drawn, showing.flipped);
}

} // namespace

Trace::Trace(int b_scans)
    : b_scans_(static_cast<std::size_t>(b_scans)), passages_(most_volumes),
      works_(most_volumes * b_scans_) {}

void Trace::add(const pipeline::Volume& volume, const Showing& showing) {
  const std::size_t place = added_++ % most_volumes;
  passages_[place] = {volume.metadata, showing};
  const auto works = works_.begin() + static_cast<std::ptrdiff_t>(place * b_scans_);
  std::copy_n(volume.work.begin(), std::min(b_scans_, volume.work.size()), works);
}

hal::Result<> Trace::write(const std::filesystem::path& file, hal::TimePoint started) const {
  const std::size_t kept = std::min(added_, most_volumes);
  std::uint32_t workers = 0;
  for (std::size_t i = 0; i < kept * b_scans_; ++i)
    workers = std::max(workers, works_[i].worker + 1);
  EventText text{started};
  add_rows(text, workers);
  for (std::size_t i = added_ - kept; i < added_; ++i) {
    const std::size_t place = i % most_volumes;
    const Passage& passage = passages_[place];
    add_volume(text, passage.metadata, passage.showing);
    for (std::size_t b = 0; b < b_scans_; ++b)
      if (const auto& work = works_[place * b_scans_ + b]; work.end != hal::TimePoint{})
        text.event(first_worker + work.worker, fmt::format("B-scan {}", b + 1),
                   passage.metadata.index, work.begin, work.end);
  }
  return pipeline::write_atomically(file, std::move(text).take());
}

} // namespace octascope::firmware_host
