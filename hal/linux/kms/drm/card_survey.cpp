#include "hal/linux/kms/drm/card_survey.h"

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>

#include "hal/linux/kms/drm/drm_resource.h"
#include "hal/linux/kms/drm/edid.h"
#include "hal/linux/kms/drm/format_blob.h"
#include "hal/linux/kms/drm/object_properties.h"
#include "hal/linux/system/system_error.h"
#include "hal/linux/system/system_files.h"

namespace octascope::hal::linux_backend::kms {

namespace {

std::string driver_of(const FileDescriptor& file) {
  const DrmVersion version{drmGetVersion(file.get())};
  if (!version || version->name == nullptr || version->name_len < 0)
    return {};
  return {version->name, static_cast<std::size_t>(version->name_len)};
}

bool has(const FileDescriptor& file, std::uint64_t capability) {
  std::uint64_t value = 0;
  return drmGetCap(file.get(), capability, &value) == 0 && value != 0;
}

ConnectionStatus status_of(drmModeConnection connection) {
  switch (connection) {
  case DRM_MODE_CONNECTED: return ConnectionStatus::connected;
  case DRM_MODE_DISCONNECTED: return ConnectionStatus::disconnected;
  default: return ConnectionStatus::unknown;
  }
}

std::string monitor_of(const FileDescriptor& file, const ObjectProperties& properties) {
  const auto id = properties.value("EDID");
  if (!id || *id == 0)
    return {};
  const DrmBlob blob{drmModeGetPropertyBlob(file.get(), static_cast<std::uint32_t>(*id))};
  if (!blob)
    return {};
  return monitor_name({static_cast<const std::uint8_t*>(blob->data), blob->length});
}

// A connector reaches a CRTC through one of its encoders.
std::uint32_t crtcs_of(const FileDescriptor& file, const drmModeConnector& connector) {
  std::uint32_t possible = 0;
  for (int i = 0; i < connector.count_encoders; ++i)
    if (const DrmEncoder encoder{drmModeGetEncoder(file.get(), connector.encoders[i])})
      possible |= encoder->possible_crtcs;
  return possible;
}

std::uint32_t current_crtc_of(const FileDescriptor& file, const drmModeConnector& connector) {
  const DrmEncoder encoder{drmModeGetEncoder(file.get(), connector.encoder_id)};
  return encoder ? encoder->crtc_id : 0;
}

Connector read_connector(const FileDescriptor& file, const drmModeConnector& connector) {
  const ObjectProperties properties{file, connector.connector_id, DRM_MODE_OBJECT_CONNECTOR};
  const char* const type = drmModeGetConnectorTypeName(connector.connector_type);
  Connector result;
  result.id = connector.connector_id;
  result.name =
      fmt::format("{}-{}", type != nullptr ? type : "Unknown", connector.connector_type_id);
  result.status = status_of(connector.connection);
  result.writeback = connector.connector_type == DRM_MODE_CONNECTOR_WRITEBACK;
  result.link_good = properties.value("link-status").value_or(0) == 0;
  result.monitor = monitor_of(file, properties);
  result.current_crtc = current_crtc_of(file, connector);
  result.possible_crtcs = crtcs_of(file, connector);
  for (int i = 0; i < connector.count_modes; ++i)
    result.modes.push_back(from_kernel(connector.modes[i]));
  return result;
}

std::vector<FormatModifier> modifiers_of(const FileDescriptor& file,
                                         const ObjectProperties& properties) {
  const auto id = properties.value("IN_FORMATS");
  if (!id || *id == 0)
    return {};
  const DrmBlob blob{drmModeGetPropertyBlob(file.get(), static_cast<std::uint32_t>(*id))};
  if (!blob)
    return {};
  return decode_formats({static_cast<const std::byte*>(blob->data), blob->length});
}

PlaneKind kind_of(std::optional<std::uint64_t> type) {
  if (!type)
    return PlaneKind::unknown;
  switch (*type) {
  case DRM_PLANE_TYPE_OVERLAY: return PlaneKind::overlay;
  case DRM_PLANE_TYPE_PRIMARY: return PlaneKind::primary;
  case DRM_PLANE_TYPE_CURSOR: return PlaneKind::cursor;
  default: return PlaneKind::unknown;
  }
}

Plane read_plane(const FileDescriptor& file, const drmModePlane& plane) {
  const ObjectProperties properties{file, plane.plane_id, DRM_MODE_OBJECT_PLANE};
  Plane result;
  result.id = plane.plane_id;
  result.kind = kind_of(properties.value("type"));
  result.current_crtc = plane.crtc_id;
  result.possible_crtcs = plane.possible_crtcs;
  result.formats.assign(plane.formats, plane.formats + plane.count_formats);
  result.modifiers = modifiers_of(file, properties);
  return result;
}

std::vector<Plane> read_planes(const FileDescriptor& file) {
  std::vector<Plane> planes;
  const DrmPlaneResources list{drmModeGetPlaneResources(file.get())};
  for (std::uint32_t i = 0; list && i < list->count_planes; ++i)
    if (const DrmPlane plane{drmModeGetPlane(file.get(), list->planes[i])})
      planes.push_back(read_plane(file, *plane));
  return planes;
}

} // namespace

std::vector<std::string> card_nodes() {
  return numbered_entries("/dev/dri", "card");
}

Card read_card(const FileDescriptor& file, const std::string& node) {
  Card card;
  card.node = node;
  card.driver = driver_of(file);
  drmSetClientCap(file.get(), DRM_CLIENT_CAP_UNIVERSAL_PLANES, 1);
  card.atomic = drmSetClientCap(file.get(), DRM_CLIENT_CAP_ATOMIC, 1) == 0;
  card.modifiers = has(file, DRM_CAP_ADDFB2_MODIFIERS);
  card.monotonic = has(file, DRM_CAP_TIMESTAMP_MONOTONIC);
  const DrmResources resources{drmModeGetResources(file.get())};
  if (!resources) {
    const bool only_computes = errno == EOPNOTSUPP || errno == EINVAL || errno == ENOTTY;
    card.problem =
        system_failure(node, fmt::format("asking \"{}\" for its outputs", card.driver), errno,
                       only_computes ? "it only computes; use another card, or choose "
                                       "--display offscreen"
                                     : "")
            .value();
    return card;
  }
  card.crtcs.assign(resources->crtcs, resources->crtcs + resources->count_crtcs);
  for (int i = 0; i < resources->count_connectors; ++i)
    if (const DrmConnector connector{drmModeGetConnector(file.get(), resources->connectors[i])})
      card.connectors.push_back(read_connector(file, *connector));
  card.planes = read_planes(file);
  return card;
}

std::vector<Card> survey() {
  std::vector<Card> cards;
  for (const std::string& node : card_nodes()) {
    const auto file = open_device(node, O_RDWR);
    if (file) {
      cards.push_back(read_card(*file, node));
    } else {
      cards.emplace_back().node = node;
      cards.back().problem = file.error();
    }
  }
  return cards;
}

} // namespace octascope::hal::linux_backend::kms
