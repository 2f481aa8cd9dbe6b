#include "firmware-host/ledger/trace.h"

#include <algorithm>
#include <iterator>
#include <span>
#include <string>

#include <fmt/format.h>

#include "pipeline/files/atomic_file.h"

namespace octascope::firmware_host {

namespace {

// Rows of the viewer: a TimingRow each, but one for every worker.
constexpr std::uint32_t rows_apart = 1000;

constexpr std::uint32_t row_of(ui::TimingRow row, std::uint32_t worker = 0) {
  return (static_cast<std::uint32_t>(row) + 1) * rows_apart + worker;
}

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
        row, name, microseconds(begin - started_), microseconds(end - begin), volume);
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

void add_rows(EventText& text, std::uint32_t worker_count) {
  using enum ui::TimingRow;
  text.name_row(row_of(exposure), "camera: exposure");
  text.name_row(row_of(camera), "camera thread: last frame");
  for (std::uint32_t worker = 0; worker < worker_count; ++worker)
    text.name_row(row_of(workers, worker), fmt::format("worker {}", worker + 1));
  text.name_row(row_of(fixed_rate), "fixed-rate thread");
  text.name_row(row_of(buffer), "triple buffer");
  text.name_row(row_of(render), "render thread");
  text.name_row(row_of(glass), "display");
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
    const std::span works{works_.data() + place * b_scans_, b_scans_};
    for_each_event(passage.metadata, works, passage.showing, [&](const PassageEvent& event) {
      const std::string name =
          event.name.empty() ? fmt::format("B-scan {}", event.b_scan + 1) : std::string{event.name};
      text.event(row_of(event.bar.row, event.bar.worker), name, passage.metadata.index,
                 event.bar.begin, event.bar.end);
    });
  }
  return pipeline::write_atomically(file, std::move(text).take());
}

} // namespace octascope::firmware_host
