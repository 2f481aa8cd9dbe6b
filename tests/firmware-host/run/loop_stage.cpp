#include "tests/firmware-host/run/loop_stage.h"

#include <algorithm>
#include <utility>

#include "tests/ui/support/synthetic_volume.h"
#include "ui/gl/framebuffer.h"

namespace octascope::tests {

namespace {

using namespace std::chrono_literals;

// Its lower left corner.
bool is_spoilt(const pipeline::Image& picture) {
  return picture.pixel(0, picture.height - 1) == std::array<std::uint8_t, 3>{255, 0, 255};
}

// A frame's bytes say which B-scan of which tissue it is.
constexpr int frames_of_a_tissue = 64;

std::array<pipeline::Volume, 2> make_tissues() {
  pipeline::Volume usual = tissue_volume(small_geometry);
  pipeline::Volume reversed = usual;
  for (int b = 0; b < usual.geometry.b_scans; ++b)
    std::ranges::copy(usual.b_scan(b), reversed.b_scan(usual.geometry.b_scans - 1 - b).begin());
  return {std::move(usual), std::move(reversed)};
}

} // namespace

// The loop asks for the size when it looks whether to draw, and once more when it draws.
int GlassDisplay::do_height() const {
  if (++sizes_asked_ == 2 && cost)
    clock_.advance(cost());
  return inner_.height();
}

hal::BackBuffer GlassDisplay::do_back_buffer() {
  if (spoils) {
    glEnable(GL_SCISSOR_TEST);
    glScissor(0, 0, 2, 2);
    glClearColor(1, 0, 1, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    glDisable(GL_SCISSOR_TEST);
  }
  return inner_.back_buffer();
}

hal::Result<hal::Flip> GlassDisplay::do_present() {
  if (covered)
    return hal::Flip{clock_.now(), last_flip_};
  pipeline::Image drawn = ui::gl::read_framebuffer(inner_.width(), inner_.height());
  auto flip = inner_.present(); // returns at the next refresh
  if (flip) {
    if (refreshes)
      flip->completed = clock_.now();
    ++frames;
    picture = std::move(drawn);
    completed = flip->completed;
    if (spoils && !is_spoilt(picture))
      whole_frames.push_back(completed);
    last_flip_ = flip->sequence;
  }
  return flip;
}

std::optional<hal::TimePoint> GlassDisplay::do_next_refresh() const {
  return refreshes && frames > 0 ? std::optional{completed + inner_.refresh_period()}
                                 : std::nullopt;
}

std::size_t GlassDisplay::do_poll_events(std::span<hal::DisplayEvent>) {
  sizes_asked_ = 0; // a turn begins
  return 0;
}

void FakeControls::send(const std::vector<hal::ControlEvent>& events) {
  const std::lock_guard lock{mutex_};
  queue_.insert(queue_.end(), events.begin(), events.end());
  changed_.notify_one();
}

hal::Result<> FakeControls::do_open() {
  set_state(hal::DeviceState::ready);
  return {};
}

hal::Result<std::size_t> FakeControls::do_read(std::span<hal::ControlEvent> events,
                                               hal::Duration timeout) {
  std::unique_lock lock{mutex_};
  changed_.wait_for(lock, timeout, [this] { return !queue_.empty(); });
  std::size_t count = 0;
  for (; count < events.size() && !queue_.empty(); ++count) {
    events[count] = queue_.front();
    queue_.pop_front();
  }
  return count;
}

void FakeScope::send(const hal::ScopeFrame& frame) {
  const std::lock_guard lock{mutex_};
  next_ = frame;
  changed_.notify_one();
}

hal::Result<> FakeScope::do_open(const hal::ScopeCameraConfig&) {
  set_state(hal::DeviceState::ready);
  return {};
}

hal::Result<> FakeScope::do_start() {
  set_state(hal::DeviceState::streaming);
  return {};
}

hal::Result<std::optional<hal::ScopeFrame>> FakeScope::do_wait_frame(hal::Duration timeout) {
  std::unique_lock lock{mutex_};
  changed_.wait_for(lock, timeout, [this] { return next_.has_value(); });
  return std::exchange(next_, std::nullopt);
}

// 40 B-scans in 141 ms.
pipeline::ScanPlan LoopStage::plan() {
  pipeline::ScanPlan plan;
  plan.samples = 2 * small_geometry.depths;
  plan.a_scans = small_geometry.a_scans;
  plan.fly_back_lines = 26;
  plan.b_scans = small_geometry.b_scans;
  plan.line_rate_hz = 126 * 40 / 0.141;
  plan.depth_spacing_um = small_geometry.depth_spacing_um;
  plan.a_spacing_um = small_geometry.a_spacing_um;
  plan.b_spacing_um = small_geometry.b_spacing_um;
  return plan;
}

ui::ControlProfile LoopStage::profile() {
  ui::ControlProfile profile;
  profile.name = "fake";
  profile.knobs = {"window", "volume"};
  profile.menu = {ui::Action::window_offset};
  profile.switch_actions = {
      {.switches = 1, .gesture = ui::GestureKind::press, .action = ui::Action::freeze},
      {.switches = 2, .gesture = ui::GestureKind::press, .action = ui::Action::auto_window},
      {.switches = 4, .gesture = ui::GestureKind::press, .action = ui::Action::snapshot}};
  profile.knob_actions = {{.knob = 0, .action = ui::Action::window_offset},
                          {.knob = 1, .action = ui::Action::rotate}};
  return profile;
}

// Later than what the fakes' threads say of themselves.
LoopStage::LoopStage() : tissues_(make_tissues()) {
  clock_.sleep_until(real_clock_.now() + 1h);
  sweep_clock_.sleep_until(clock_.now());
}

void LoopStage::SetUp() {
  if (const auto opened = display_.open({}); !opened)
    GTEST_SKIP() << opened.error().message;
  display_.close();
  hal::LineCameraConfig config;
  config.format.samples_per_line = plan().samples;
  config.format.lines_per_frame = plan().lines_per_frame();
  config.buffers = 96;
  acquisition_ =
      std::make_unique<pipeline::Acquisition>(camera_, config, real_clock_, faults_, arrived_);
  pipeline::VolumeThreadSetup setup{
      .plan = plan(),
      .trigger = {},
      .workers = 1,
      .reconstruct =
          [this](std::size_t, const hal::LineFrame& frame, std::span<std::uint8_t> levels) {
            const int fill = std::to_integer<int>(frame.bytes.front());
            const pipeline::Volume& tissue =
                tissues_[static_cast<std::size_t>(fill / frames_of_a_tissue)];
            std::ranges::copy(tissue.b_scan(fill % frames_of_a_tissue), levels.begin());
            return 0;
          },
      .average = *pipeline::NeighbourAverage::create({0, 1, 0}),
      .most_volumes = std::nullopt,
  };
  volumes_ = std::make_unique<pipeline::VolumeThread>(
      std::move(setup), trigger_, *acquisition_, camera_, sweep_clock_, faults_, arrived_, news_);
  control_thread_ =
      std::make_unique<pipeline::ControlThread>(controls_, real_clock_, faults_, news_);
  scope_thread_ = std::make_unique<pipeline::ScopeThread>(scope_, hal::ScopeCameraConfig{},
                                                          real_clock_, faults_, news_);
  ASSERT_TRUE(acquisition_->start({}));
  await("the camera", [&] { return camera_.state() == hal::DeviceState::streaming; });
  volumes_->start({});
  control_thread_->start({});
  scope_thread_->start({});
}

void LoopStage::TearDown() {
  loop_.reset();
  if (scope_thread_)
    scope_thread_->stop();
  if (control_thread_)
    control_thread_->stop();
  if (volumes_)
    volumes_->stop();
  if (acquisition_)
    acquisition_->stop();
}

firmware_host::RenderLoopSetup LoopStage::setup() {
  firmware_host::RenderLoopSetup setup;
  setup.display.width = 640;
  setup.display.height = 360;
  setup.controls = profile();
  setup.window_from_first_volume = false;
  setup.geometry = plan().geometry();
  return setup;
}

void LoopStage::open(firmware_host::RenderLoopSetup setup, pipeline::VolumeFeed& volumes,
                     const pipeline::Acquisition* acquisition, pipeline::ScopeThread* scope) {
  loop_ = std::make_unique<firmware_host::RenderLoop>(
      firmware_host::RenderLoopParts{
          .display = display_,
          .clock = clock_,
          .volumes = volumes,
          .acquisition = acquisition,
          .scope = scope,
          .controls = *control_thread_,
          .faults = faults_,
          .news = news_,
          .keep_picture = [this](const pipeline::Image&) { return ++kept_pictures_ > 0; },
          .simulated_control = {},
          .threads = {},
          .vessels = vessels_.get(),
          .proof = &proof_},
      std::move(setup));
  const auto opened = loop_->open();
  ASSERT_TRUE(opened) << opened.error().message;
}

void LoopStage::start(ui::ViewState view) {
  firmware_host::RenderLoopSetup live = setup();
  live.view = view;
  live.lines_per_frame = plan().lines_per_frame();
  live.freshness.volume_period = plan().tick_period();
  open(std::move(live), *volumes_, acquisition_.get(), scope_thread_.get());
}

void LoopStage::turn() {
  const hal::TimePoint next = clock_.now() + display_.refresh_period();
  news_.post(); // so that the loop does not wait for real
  loop_->turn();
  if (clock_.now() < next)
    clock_.advance(next - clock_.now());
}

void LoopStage::draw_for(hal::Duration full, hal::Duration rest,
                         std::function<void(const ui::DrawQuality&)> anew) {
  struct Drawn {
    ui::DrawQuality quality;
    ui::ViewState view;
    std::uint64_t published = 0;
  };
  display_.cost = [this, full, rest, anew = std::move(anew), last = Drawn{}]() mutable {
    const Drawn now{loop_->quality(), view(), volumes_->counters().published};
    const bool differs =
        now.published > 0 && (now.quality != last.quality || now.published != last.published ||
                              !ui::same_sight(now.view, last.view));
    last = now;
    if (!differs)
      return rest;
    if (anew)
      anew(now.quality);
    return rest + hal::from_seconds(hal::to_seconds(full) * ui::sample_share(now.quality));
  };
}

void LoopStage::turn_until(hal::TimePoint time) {
  while (clock_.now() < time)
    turn();
}

void LoopStage::rest() {
  turn_until(clock_.now() + 2 * ui::Governor::rest_after);
}

void LoopStage::send_volume(Tissue tissue) {
  sweep_clock_.sleep_until(clock_.now()); // the tick is due
  const hal::TimePoint pulsed = trigger_.wait_for_pulse(next_pulse_++);
  const hal::TimePoint end = pulsed + plan().tick_period();
  while (clock_.now() + longest_turn_ < end)
    turn();
  ASSERT_LE(clock_.now(), end) << "the last frame took longer than a volume";
  clock_.advance(end - clock_.now());
  sweep_clock_.sleep_until(end);
  const std::uint64_t published = volumes_->counters().published;
  pulsed_ = pulsed;
  for (int b = 0; b < small_geometry.b_scans; ++b)
    deliver(tissue, b);
  await("the volume", [&] { return volumes_->counters().published > published; });
}

void LoopStage::deliver(Tissue tissue, int b_scan) {
  camera_.deliver(
      sequence_++, exposed(b_scan),
      static_cast<std::uint8_t>(frames_of_a_tissue * static_cast<int>(tissue) + b_scan));
}

void LoopStage::send_b_scans(Tissue tissue, int from, int to) {
  if (from == 0) {
    sweep_clock_.sleep_until(clock_.now());
    pulsed_ = trigger_.wait_for_pulse(next_pulse_++);
  }
  turn_until(exposed(to));
  const std::uint64_t published = volumes_->counters().published;
  for (int b = from; b < to; ++b)
    deliver(tissue, b);
  const bool whole = to == small_geometry.b_scans;
  await("the B-scans", [&] {
    if (whole)
      return volumes_->counters().published > published;
    const auto making = volumes_->borrow_after(published);
    volumes_->give_back();
    return making && to >= 2 &&
           making->progress[static_cast<std::size_t>(to) - 2].load() ==
               pipeline::BScanProgress::finished;
  });
}

void LoopStage::resume_sweeps() {
  next_pulse_ = trigger_.pulses();
  camera_.replug();
  await("the camera", [&] { return camera_.state() == hal::DeviceState::streaming; });
  turn_until(clock_.now() + plan().tick_period());
}

void LoopStage::await(std::string_view what, const std::function<bool()>& came) {
  const hal::TimePoint patience = real_clock_.now() + 60s;
  while (!came()) {
    ASSERT_LT(real_clock_.now(), patience) << what << " does not come";
    real_clock_.sleep_for(1ms);
  }
}

void LoopStage::await_news() {
  ASSERT_TRUE(news_.wait_until(real_clock_, real_clock_.now() + 60s))
      << "a fake's thread stands still";
}

void LoopStage::send_controls(const std::vector<hal::ControlEvent>& events) {
  news_.wait_until(real_clock_, {}); // forgets what is old
  for (const hal::ControlEvent& event : events) {
    controls_.send({event});
    await_news();
  }
}

void LoopStage::turn_knob(std::uint8_t knob, int detents) {
  send_controls({{clock_.now(), hal::ControlKind::knob, knob, detents}});
}

void LoopStage::press_freeze() {
  send_controls({{clock_.now(), hal::ControlKind::pedal_switch, 0, 1},
                 {clock_.now(), hal::ControlKind::pedal_switch, 0, 0}});
}

void LoopStage::send_scope_picture() {
  news_.wait_until(real_clock_, {});
  scope_.send(scope_picture_.frame(clock_.now()));
  await_news();
}

ui::Layout LoopStage::layout() const {
  const pipeline::VolumeGeometry& g = small_geometry;
  return ui::lay_out(display_.width(), display_.height(),
                     {.b_scan = g.a_mm() / g.depth_mm(),
                      .en_face = g.a_mm() / g.b_mm(),
                      .scope = 64.0 / 48,
                      .has_scope = true},
                     view().layout);
}

} // namespace octascope::tests
