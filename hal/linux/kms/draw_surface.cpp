#include "hal/linux/kms/draw_surface.h"

#include <array>
#include <cerrno>
#include <string_view>
#include <system_error>

#define EGL_NO_X11
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <drm_fourcc.h>
#include <fmt/format.h>
#include <gbm.h>

#include "hal/linux/kms/drm/drm_resource.h"
#include "hal/linux/kms/graphics_reset.h"
#include "hal/linux/kms/mode/output_choice.h"

namespace octascope::hal::linux_backend::kms {

namespace {

tl::unexpected<Error> no_egl(const Card& card, std::string_view found) {
  return fail(ErrorCode::unsupported,
              "kms display: {} on {} ({}; EGL error 0x{:04x}), expected GLES 3 on GBM; install "
              "libegl-mesa0, libgbm1 and libgl1-mesa-dri, or the driver's own EGL; where no GPU is "
              "meant to be, set LIBGL_ALWAYS_SOFTWARE=1",
              found, card.node, card.driver, static_cast<unsigned>(eglGetError()));
}

bool has_extension(const char* list, std::string_view name) {
  return list != nullptr && std::string_view{list}.find(name) != std::string_view::npos;
}

std::uint32_t format_of(EGLDisplay display, EGLConfig config) {
  EGLint format = 0;
  eglGetConfigAttrib(display, config, EGL_NATIVE_VISUAL_ID, &format);
  return static_cast<std::uint32_t>(format);
}

std::vector<EGLConfig> drawable_configs(EGLDisplay display) {
  constexpr std::array<EGLint, 5> wanted{EGL_RENDERABLE_TYPE, EGL_OPENGL_ES3_BIT, EGL_SURFACE_TYPE,
                                         EGL_WINDOW_BIT, EGL_NONE};
  EGLint count = 0;
  if (eglChooseConfig(display, wanted.data(), nullptr, 0, &count) != EGL_TRUE || count < 1)
    return {};
  std::vector<EGLConfig> configs(static_cast<std::size_t>(count));
  if (eglChooseConfig(display, wanted.data(), configs.data(), count, &count) != EGL_TRUE)
    return {};
  configs.resize(static_cast<std::size_t>(count));
  return configs;
}

// What a buffer has from its first picture on, for as long as GBM keeps it.
struct KnownBuffer {
  int card = -1;
  std::uint32_t framebuffer = 0;
  void* mapping = nullptr; // GBM's; null: none is held
};

void forget_buffer(gbm_bo* buffer, void* data) {
  const std::unique_ptr<KnownBuffer> known{static_cast<KnownBuffer*>(data)};
  if (known->mapping != nullptr)
    gbm_bo_unmap(buffer, known->mapping);
  drmModeRmFB(known->card, known->framebuffer);
}

bool draws_in_software(EGLDisplay display) {
  if (!has_extension(eglQueryString(display, EGL_EXTENSIONS), "EGL_MESA_query_driver"))
    return false;
  const auto name_of = reinterpret_cast<PFNEGLGETDISPLAYDRIVERNAMEPROC>(
      eglGetProcAddress("eglGetDisplayDriverName"));
  const char* const name = name_of != nullptr ? name_of(display) : nullptr;
  return name != nullptr && std::string_view{name}.find("swrast") != std::string_view::npos;
}

// Mesa's software renderer maps a buffer for each picture and gives the mapping back when it is drawn, so that
// each finds all of its pages anew. It takes the mapping that there is; null: it has to do without.
void* hold_mapping(gbm_bo* buffer) {
  std::uint32_t stride = 0;
  void* mapping = nullptr;
  gbm_bo_map(buffer, 0, 0, gbm_bo_get_width(buffer), gbm_bo_get_height(buffer),
             GBM_BO_TRANSFER_READ_WRITE, &stride, &mapping);
  return mapping;
}

struct BufferLayout {
  std::array<std::uint32_t, 4> handles{};
  std::array<std::uint32_t, 4> strides{};
  std::array<std::uint32_t, 4> offsets{};
  std::array<std::uint64_t, 4> modifiers{};
};

BufferLayout layout_of(gbm_bo* buffer) {
  BufferLayout layout;
  const auto planes = static_cast<std::size_t>(std::max(gbm_bo_get_plane_count(buffer), 1));
  for (std::size_t i = 0; i < std::min<std::size_t>(planes, 4); ++i) {
    const int plane = static_cast<int>(i);
    layout.handles[i] = gbm_bo_get_handle_for_plane(buffer, plane).u32;
    layout.strides[i] = gbm_bo_get_stride_for_plane(buffer, plane);
    layout.offsets[i] = gbm_bo_get_offset(buffer, plane);
    layout.modifiers[i] = gbm_bo_get_modifier(buffer);
  }
  return layout;
}

// 0 or an errno. A modifier that is unknown must not be named: some drivers then refuse the mode.
int add_framebuffer(int card, bool name_modifier, gbm_bo* buffer, std::uint32_t& id) {
  const BufferLayout layout = layout_of(buffer);
  const std::uint32_t width = gbm_bo_get_width(buffer);
  const std::uint32_t height = gbm_bo_get_height(buffer);
  const std::uint32_t format = gbm_bo_get_format(buffer);
  if (name_modifier && layout.modifiers[0] != DRM_FORMAT_MOD_INVALID &&
      drmModeAddFB2WithModifiers(card, width, height, format, layout.handles.data(),
                                 layout.strides.data(), layout.offsets.data(),
                                 layout.modifiers.data(), &id, DRM_MODE_FB_MODIFIERS) == 0)
    return 0;
  return drmModeAddFB2(card, width, height, format, layout.handles.data(), layout.strides.data(),
                       layout.offsets.data(), &id, 0) == 0
             ? 0
             : errno;
}

} // namespace

struct DrawSurface::Parts {
  int card = -1;
  bool can_name_modifiers = false;
  bool has_modifiers = false;
  gbm_device* device = nullptr;
  gbm_surface* buffers = nullptr;
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT;
  EGLSurface surface = EGL_NO_SURFACE;
  GraphicsReset reset;
  PFNEGLCREATESYNCKHRPROC create_sync = nullptr; // null: the driver has no fences of its own
  PFNEGLDESTROYSYNCKHRPROC destroy_sync = nullptr;
  PFNEGLDUPNATIVEFENCEFDANDROIDPROC fence_of = nullptr;

  Parts() = default;
  Parts(const Parts&) = delete;
  Parts& operator=(const Parts&) = delete;

  ~Parts() {
    if (display != EGL_NO_DISPLAY) {
      if (context != EGL_NO_CONTEXT && eglGetCurrentContext() == context)
        eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
      if (surface != EGL_NO_SURFACE)
        eglDestroySurface(display, surface);
      if (context != EGL_NO_CONTEXT)
        eglDestroyContext(display, context);
      eglTerminate(display); // ours alone: it is of our GBM device
    }
    if (buffers != nullptr)
      gbm_surface_destroy(buffers);
    if (device != nullptr)
      gbm_device_destroy(device);
  }

  Result<> start_egl(const Card& described) {
    device = gbm_create_device(card);
    if (device == nullptr)
      return no_egl(described, "no GBM device could be made");
    if (!has_extension(eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS), "_platform_gbm"))
      return no_egl(described, "this EGL knows no GBM");
    const EGLDisplay found = eglGetPlatformDisplay(EGL_PLATFORM_GBM_KHR, device, nullptr);
    if (found == EGL_NO_DISPLAY || eglInitialize(found, nullptr, nullptr) != EGL_TRUE)
      return no_egl(described, "EGL could not be initialised");
    display = found;
    eglBindAPI(EGL_OPENGL_ES_API);
    const char* const extensions = eglQueryString(display, EGL_EXTENSIONS);
    if (has_extension(extensions, "EGL_ANDROID_native_fence_sync"))
      find_fence_calls();
    knows_ages = has_extension(extensions, "EGL_EXT_buffer_age");
    in_software = draws_in_software(display);
    return {};
  }

  void find_fence_calls() {
    create_sync = reinterpret_cast<PFNEGLCREATESYNCKHRPROC>(eglGetProcAddress("eglCreateSyncKHR"));
    destroy_sync =
        reinterpret_cast<PFNEGLDESTROYSYNCKHRPROC>(eglGetProcAddress("eglDestroySyncKHR"));
    fence_of = reinterpret_cast<PFNEGLDUPNATIVEFENCEFDANDROIDPROC>(
        eglGetProcAddress("eglDupNativeFenceFDANDROID"));
    if (destroy_sync == nullptr || fence_of == nullptr)
      create_sync = nullptr;
  }

  Result<> make_surface(const DrawSurfaceSetup& setup) {
    const std::vector<EGLConfig> configs = drawable_configs(display);
    std::vector<std::uint32_t> drawable;
    for (const EGLConfig config : configs)
      drawable.push_back(format_of(display, config));
    const auto formats = common_formats(setup.plane, drawable);
    if (formats.empty())
      return no_egl(setup.card, "no pixel format that EGL draws can be shown");
    for (const std::uint32_t format : formats) {
      make_buffers(setup, format);
      for (std::size_t i = 0; buffers != nullptr && i < configs.size(); ++i)
        if (drawable[i] == format && make_context(configs[i]))
          return {};
    }
    return no_egl(setup.card, fmt::format("no surface of {}x{} could be made ({})", setup.width,
                                          setup.height, std::generic_category().message(errno)));
  }

  // Null where the card has no memory of that kind.
  void make_buffers(const DrawSurfaceSetup& setup, std::uint32_t format) {
    if (buffers != nullptr)
      gbm_surface_destroy(buffers);
    buffers = nullptr;
    const auto width = static_cast<std::uint32_t>(setup.width);
    const auto height = static_cast<std::uint32_t>(setup.height);
    const auto modifiers = setup.modifiers ? usable_modifiers(setup.card, setup.plane, format)
                                           : std::vector<std::uint64_t>{};
    if (!modifiers.empty())
      buffers = gbm_surface_create_with_modifiers2(device, width, height, format, modifiers.data(),
                                                   static_cast<unsigned>(modifiers.size()),
                                                   GBM_BO_USE_SCANOUT | GBM_BO_USE_RENDERING);
    has_modifiers = buffers != nullptr;
    if (buffers == nullptr)
      buffers = gbm_surface_create(device, width, height, format,
                                   GBM_BO_USE_SCANOUT | GBM_BO_USE_RENDERING);
  }

  bool make_context(EGLConfig config) {
    for (const auto& attributes : GraphicsReset::context_attributes(display))
      if (context == EGL_NO_CONTEXT)
        context = eglCreateContext(display, config, EGL_NO_CONTEXT, attributes.data());
    surface = eglCreatePlatformWindowSurface(display, config, buffers, nullptr);
    if (context != EGL_NO_CONTEXT && surface != EGL_NO_SURFACE &&
        eglMakeCurrent(display, surface, surface, context) == EGL_TRUE) {
      reset = GraphicsReset::of_current_context();
      return true;
    }
    if (surface != EGL_NO_SURFACE)
      eglDestroySurface(display, surface);
    if (context != EGL_NO_CONTEXT)
      eglDestroyContext(display, context);
    surface = EGL_NO_SURFACE;
    context = EGL_NO_CONTEXT;
    return false;
  }

  // The drawing's end as a file; −1 where the driver cannot say.
  FileDescriptor swap_with_fence() {
    constexpr std::array<EGLint, 3> no_fence_yet{EGL_SYNC_NATIVE_FENCE_FD_ANDROID,
                                                 EGL_NO_NATIVE_FENCE_FD_ANDROID, EGL_NONE};
    const EGLSyncKHR sync =
        create_sync(display, EGL_SYNC_NATIVE_FENCE_ANDROID, no_fence_yet.data());
    swapped = eglSwapBuffers(display, surface) == EGL_TRUE;
    if (sync == EGL_NO_SYNC_KHR)
      return {};
    FileDescriptor fence{fence_of(display, sync)}; // there only after the swap has flushed it
    destroy_sync(display, sync);
    return fence;
  }

  bool swapped = false;
  bool knows_ages = false;
  bool in_software = false;
  std::uint64_t images = 0; // swapped so far
};

DrawSurface::DrawSurface(std::unique_ptr<Parts> parts) : parts_{std::move(parts)} {}
DrawSurface::~DrawSurface() = default;

Result<std::unique_ptr<DrawSurface>> DrawSurface::create(const FileDescriptor& card,
                                                         const DrawSurfaceSetup& setup) {
  auto parts = std::make_unique<Parts>();
  parts->card = card.get();
  parts->can_name_modifiers = setup.card.modifiers;
  HAL_CHECK(parts->start_egl(setup.card));
  HAL_CHECK(parts->make_surface(setup));
  return std::unique_ptr<DrawSurface>{new DrawSurface{std::move(parts)}};
}

bool DrawSurface::uses_modifiers() const {
  return parts_->has_modifiers;
}

BackBuffer DrawSurface::back_buffer() const {
  BackBuffer buffer{parts_->images + 1, 0};
  EGLint age = 0; // in images; 0: the content is undefined
  if (parts_->knows_ages &&
      eglQuerySurface(parts_->display, parts_->surface, EGL_BUFFER_AGE_EXT, &age) == EGL_TRUE &&
      age > 0 && static_cast<std::uint64_t>(age) <= parts_->images)
    buffer.holds = buffer.image - static_cast<std::uint64_t>(age);
  return buffer;
}

Result<DrawnPicture> DrawSurface::take_picture(bool with_fence) {
  // Before the flip: it would show an old picture as if it were new.
  if (const auto cause = parts_->reset.cause())
    return fail(ErrorCode::disconnected,
                "kms display: the graphics processor was reset ({}), and what was drawn is lost; "
                "it is opened again",
                *cause);
  DrawnPicture picture;
  if (with_fence && parts_->create_sync != nullptr)
    picture.fence = parts_->swap_with_fence();
  else
    parts_->swapped = eglSwapBuffers(parts_->display, parts_->surface) == EGL_TRUE;
  if (!parts_->swapped)
    return fail(ErrorCode::disconnected,
                "kms display: the picture could not be finished (EGL error 0x{:04x}): the graphics "
                "device is gone or has been reset; it is opened again",
                static_cast<unsigned>(eglGetError()));
  ++parts_->images;
  picture.buffer = gbm_surface_lock_front_buffer(parts_->buffers);
  if (picture.buffer == nullptr)
    return fail(ErrorCode::system, "kms display: no buffer with the picture; it is opened again");
  auto* known = static_cast<KnownBuffer*>(gbm_bo_get_user_data(picture.buffer));
  if (known == nullptr) {
    auto made = std::make_unique<KnownBuffer>();
    made->card = parts_->card;
    if (const int error = add_framebuffer(parts_->card, parts_->can_name_modifiers, picture.buffer,
                                          made->framebuffer)) {
      release(picture.buffer);
      return fail(
          ErrorCode::system,
          "kms display: the card did not take a buffer as a picture: {}; it is opened again",
          std::generic_category().message(error));
    }
    if (parts_->in_software)
      made->mapping = hold_mapping(picture.buffer);
    known = made.release();
    gbm_bo_set_user_data(picture.buffer, known, forget_buffer);
  }
  picture.framebuffer = known->framebuffer;
  return picture;
}

void DrawSurface::release(gbm_bo* buffer) {
  if (buffer != nullptr)
    gbm_surface_release_buffer(parts_->buffers, buffer);
}

} // namespace octascope::hal::linux_backend::kms
