#include "hal/linux/libcamera/camera_link.h"

#include <algorithm>
#include <cerrno>
#include <utility>

#include <fmt/format.h>
#include <libcamera/camera.h>
#include <libcamera/controls.h>
#include <libcamera/framebuffer_allocator.h>
#include <libcamera/request.h>

#include "hal/linux/libcamera/libcamera_version.h"
#include "hal/linux/libcamera/mapped_picture.h"
#include "hal/linux/system/system_error.h"

namespace octascope::hal::linux_backend {

namespace {

constexpr unsigned wanted_buffers = 6;

Error failure(const std::string& model, std::string_view action, int result) {
  constexpr std::string_view who_has_it =
      "another program has it: `sudo fuser -v /dev/media* /dev/video*` names it; end that program";
  return system_failure(fmt::format("scope camera \"{}\"", model), action, -result,
                        result == -EBUSY ? who_has_it : std::string_view{})
      .value();
}

std::vector<CameraFormat> offered_by(const libcamera::StreamConfiguration& stream) {
  std::vector<CameraFormat> offers;
  const libcamera::StreamFormats& formats = stream.formats();
  for (const libcamera::PixelFormat& format : formats.pixelformats()) {
    CameraFormat offer{format.fourcc(), {}, {}};
    for (const libcamera::Size& size : formats.sizes(format))
      offer.sizes.push_back({static_cast<int>(size.width), static_cast<int>(size.height)});
    const libcamera::SizeRange range = formats.range(format);
    if (range.hStep > 0 && range.vStep > 0)
      offer.range = {{static_cast<int>(range.min.width), static_cast<int>(range.min.height)},
                     {static_cast<int>(range.max.width), static_cast<int>(range.max.height)}};
    offers.push_back(std::move(offer));
  }
  // A camera that tells no formats is asked with what it configures by itself.
  if (offers.empty())
    offers.push_back({stream.pixelFormat.fourcc(),
                      {{static_cast<int>(stream.size.width), static_cast<int>(stream.size.height)}},
                      {}});
  return offers;
}

std::string names_of(const std::vector<CameraFormat>& offers) {
  std::string names;
  for (const CameraFormat& offer : offers)
    names += (names.empty() ? "" : ", ") + format_name(offer.fourcc);
  return names;
}

} // namespace

void SignalListener::listen_to(const std::shared_ptr<libcamera::Camera>& camera) {
  queue_->listen_to(camera.get());
  std::erase_if(connected_, [](const auto& known) { return known.expired(); });
  const bool known =
      std::ranges::any_of(connected_, [&](const auto& other) { return other.lock() == camera; });
  if (known)
    return;
  // The lambdas own a share of the queue and name the camera by its address alone: it owns them.
  const void* const whose = camera.get();
  camera->requestCompleted.connect(queue_.get(),
                                   [queue = queue_, whose](libcamera::Request* request) {
                                     queue->add(whose, request->cookie());
                                   });
  camera->disconnected.connect(queue_.get(), [queue = queue_, whose] { queue->close(whose); });
  connected_.push_back(camera);
}

// Destroyed from the bottom: pictures before the buffers whose descriptors they borrow, requests
// before the camera that they name.
struct CameraLink::Parts {
  ~Parts() {
    const bool abandoned = running && !can_be_stopped();
    if (running && !abandoned)
      camera->stop();
    pictures.clear();
    requests.clear();
    allocator.reset();
    configuration.reset();
    if (abandoned) {
      static_cast<void>(new std::shared_ptr<libcamera::Camera>{camera}); // never dropped
      shut_nodes();
    } else if (acquired)
      camera->release();
  }

  Result<> configure(const ScopeCameraConfig& config);
  Result<> allocate();
  bool can_be_stopped() const { return nodes.present() && !broken_off && !shut; }
  void shut_nodes() {
    if (!std::exchange(shut, true))
      nodes.shut();
  }

  std::shared_ptr<libcamera::Camera> camera;
  std::string model;
  CameraNodes nodes;
  bool acquired = false;
  bool running = false;
  bool broken_off = false; // it gave up a request in mid-stream
  bool shut = false;       // its nodes are
  std::unique_ptr<libcamera::CameraConfiguration> configuration;
  PictureLayout layout;
  libcamera::Stream* stream = nullptr;
  std::unique_ptr<libcamera::FrameBufferAllocator> allocator;
  std::vector<std::unique_ptr<libcamera::Request>> requests;
  std::vector<MappedPicture> pictures;
};

Result<> CameraLink::Parts::configure(const ScopeCameraConfig& config) {
  configuration = display_configuration(*camera);
  if (!configuration || configuration->empty())
    return fail(ErrorCode::unsupported,
                "scope camera \"{}\": it has no stream for a display; take another camera", model);
  libcamera::StreamConfiguration& wanted = configuration->at(0);
  const std::vector<CameraFormat> offers = offered_by(wanted);
  for (const FormatCandidate& format : choose_formats(offers, config)) {
    wanted.pixelFormat = libcamera::PixelFormat{format.fourcc};
    wanted.size = {static_cast<unsigned>(format.size.width),
                   static_cast<unsigned>(format.size.height)};
    wanted.bufferCount = wanted_buffers;
    wanted.colorSpace = libcamera::ColorSpace::Smpte170m; // BT.601, limited range: as it is drawn
    if (configuration->validate() == libcamera::CameraConfiguration::Invalid)
      continue;
    const auto encoding = encoding_of(wanted.pixelFormat.fourcc()); // perhaps adjusted
    if (!encoding)
      continue;
    if (const int result = camera->configure(configuration.get()); result < 0)
      return tl::make_unexpected(failure(model, "configuring it", result));
    layout = {*encoding,
              {static_cast<int>(wanted.size.width), static_cast<int>(wanted.size.height)},
              wanted.stride};
    stream = wanted.stream();
    return {};
  }
  return fail(ErrorCode::unsupported,
              "scope camera \"{}\": found the formats {}, expected NV12, YUYV, BGR888, XBGR8888, "
              "ABGR8888 or MJPEG; take another camera",
              model, names_of(offers));
}

Result<> CameraLink::Parts::allocate() {
  allocator = std::make_unique<libcamera::FrameBufferAllocator>(camera);
  if (const int result = allocator->allocate(stream); result < 0)
    return tl::make_unexpected(failure(model, "allocating its buffers", result));
  for (const auto& buffer : allocator->buffers(stream)) {
    if (requests.size() == most_buffers)
      break;
    HAL_TRY(auto plan, plan_planes(planes_of(*buffer), layout));
    HAL_TRY(auto picture, MappedPicture::map(plan, layout.bytes(), "scope camera"));
    auto request = camera->createRequest(requests.size());
    if (!request)
      return tl::make_unexpected(failure(model, "making a request", -ENODEV));
    if (const int result = request->addBuffer(stream, buffer.get()); result < 0)
      return tl::make_unexpected(failure(model, "giving a request its buffer", result));
    pictures.push_back(std::move(picture));
    requests.push_back(std::move(request));
  }
  if (requests.empty())
    return fail(ErrorCode::bad_data,
                "scope camera \"{}\": its driver gave no buffer, expected {}; plug it in again",
                model, wanted_buffers);
  return {};
}

Result<std::unique_ptr<CameraLink>> CameraLink::open(const LibcameraSession::Chosen& chosen,
                                                     const ScopeCameraConfig& config) {
  auto parts = std::make_unique<Parts>();
  parts->camera = chosen.camera;
  parts->model = chosen.model;
  parts->nodes = chosen.nodes;
  // ENODEV: it was pulled out since it was listed, so it is not there.
  if (const int result = parts->camera->acquire(); result < 0)
    return tl::make_unexpected(
        failure(chosen.model, "opening", result == -ENODEV ? -ENOENT : result));
  parts->acquired = true;
  if (auto done = parts->configure(config).and_then([&] { return parts->allocate(); }); !done)
    return tl::make_unexpected(done.error());
  return std::unique_ptr<CameraLink>(new CameraLink{std::move(parts)});
}

bool CameraLink::is_free(const LibcameraSession::Chosen& chosen) {
  if (chosen.camera->acquire() < 0)
    return false;
  chosen.camera->release();
  return true;
}

CameraLink::CameraLink(std::unique_ptr<Parts> parts) : parts_{std::move(parts)} {}
CameraLink::~CameraLink() = default;

const std::string& CameraLink::model() const {
  return parts_->model;
}
const PictureLayout& CameraLink::layout() const {
  return parts_->layout;
}
std::size_t CameraLink::buffers() const {
  return parts_->requests.size();
}

Result<> CameraLink::start(Duration period) {
  libcamera::ControlList controls{parts_->camera->controls()};
  ask_for_period(*parts_->camera, period, controls);
  if (const int result = parts_->camera->start(&controls); result < 0)
    return tl::make_unexpected(failure(parts_->model, "starting", result));
  parts_->running = true;
  return {};
}

void CameraLink::stop() {
  if (!parts_->running || !parts_->can_be_stopped())
    return;
  parts_->camera->stop();
  parts_->running = false;
}

bool CameraLink::watched() const {
  return parts_->nodes.watched();
}

void CameraLink::stopped_by_itself() {
  parts_->running = false;
}

bool CameraLink::present() const {
  return parts_->nodes.present();
}

bool CameraLink::can_be_stopped() const {
  return parts_->can_be_stopped();
}

bool CameraLink::will_be_abandoned() const {
  return parts_->running && !parts_->can_be_stopped();
}

void CameraLink::shut_nodes() {
  parts_->shut_nodes();
}

Result<> CameraLink::queue(std::size_t buffer) {
  parts_->pictures[buffer].end_reading();
  libcamera::Request& request = *parts_->requests[buffer];
  request.reuse(libcamera::Request::ReuseBuffers);
  if (const int result = parts_->camera->queueRequest(&request); result < 0)
    return tl::make_unexpected(failure(parts_->model, "giving it a buffer", result));
  return {};
}

bool CameraLink::given_up(std::size_t buffer) {
  const libcamera::Request& request = *parts_->requests[buffer];
  const bool cancelled = request.status() == libcamera::Request::RequestCancelled ||
                         request.findBuffer(parts_->stream)->metadata().status ==
                             libcamera::FrameMetadata::FrameCancelled;
  parts_->broken_off = parts_->broken_off || cancelled;
  return cancelled;
}

CameraLink::Completed CameraLink::completed(std::size_t buffer) {
  libcamera::Request& request = *parts_->requests[buffer];
  const libcamera::FrameBuffer& filled = *request.findBuffer(parts_->stream);
  const libcamera::FrameMetadata& facts = filled.metadata();
  const RequestStamp stamp{facts.sequence, exposure_time(request), facts.timestamp};
  if (facts.status != libcamera::FrameMetadata::FrameSuccess)
    return {false, stamp, {}};
  std::span<const std::byte> bytes = parts_->pictures[buffer].begin_reading();
  if (parts_->layout.encoding == Encoding::motion_jpeg)
    bytes = bytes.first(std::min(bytes.size(), bytes_used(filled)));
  return {true, stamp, bytes};
}

} // namespace octascope::hal::linux_backend
