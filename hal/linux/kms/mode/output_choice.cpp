#include "hal/linux/kms/mode/output_choice.h"

#include <algorithm>
#include <array>
#include <optional>

#include <drm_fourcc.h>
#include <fmt/format.h>

namespace octascope::hal::linux_backend::kms {

namespace {

struct Socket {
  std::size_t card = 0;
  std::size_t connector = 0;
};

const Connector& at(std::span<const Card> cards, const Socket& socket) {
  return cards[socket.card].connectors[socket.connector];
}

bool is_named(const Card& card, const Connector& connector, const std::string& name) {
  return connector.name == name || card_name(card) + ":" + connector.name == name;
}

std::vector<Socket> sockets_of(std::span<const Card> cards, const std::string& name) {
  std::vector<Socket> found;
  for (std::size_t c = 0; c < cards.size(); ++c)
    for (std::size_t i = 0; i < cards[c].connectors.size(); ++i) {
      const Connector& connector = cards[c].connectors[i];
      if (!connector.writeback && (name.empty() || is_named(cards[c], connector, name)))
        found.push_back({c, i});
    }
  return found;
}

std::string_view to_words(ConnectionStatus status) {
  switch (status) {
  case ConnectionStatus::connected: return "connected";
  case ConnectionStatus::disconnected: return "disconnected";
  case ConnectionStatus::unknown: return "unknown";
  }
  return "unknown";
}

std::string list_of(std::span<const Card> cards) {
  std::string list;
  for (const Socket& socket : sockets_of(cards, ""))
    list += fmt::format("{}{}:{} ({})", list.empty() ? "" : ", ", card_name(cards[socket.card]),
                        at(cards, socket).name, to_words(at(cards, socket).status));
  return list.empty() ? "none" : list;
}

// No card can be used: the first one's problem, or that there is none.
tl::unexpected<Error> no_card(std::span<const Card> cards) {
  for (const Card& card : cards)
    if (card.problem)
      return tl::make_unexpected(*card.problem);
  return fail(ErrorCode::absent,
              cards.empty()
                  ? "kms display: no /dev/dri/card* found, expected the node of a graphics device; "
                    "see with `lspci -k` whether its driver is loaded, or choose --display window "
                    "or --display offscreen"
                  : "kms display: the graphics devices have no sockets for monitors; choose "
                    "--display offscreen");
}

tl::unexpected<Error> nothing_connected(std::span<const Card> cards, const std::string& name) {
  const std::string list = list_of(cards);
  if (sockets_of(cards, name).empty())
    return fail(ErrorCode::absent,
                "kms display: no connector \"{}\", expected one of: {}; fix the configured name",
                name, list);
  return fail(ErrorCode::absent,
              "kms display: no monitor found{}; connectors: {}; check the cable and the monitor's "
              "power; it is tried again by itself",
              name.empty() ? "" : " at " + name, list);
}

std::optional<Socket> choose_socket(std::span<const Card> cards, const std::string& name) {
  const auto sockets = sockets_of(cards, name);
  // A socket that cannot tell is better than none, where modes are known.
  for (const auto status : {ConnectionStatus::connected, ConnectionStatus::unknown})
    for (const Socket& socket : sockets) {
      const Connector& connector = at(cards, socket);
      if (connector.status == status &&
          (status == ConnectionStatus::connected || !connector.modes.empty()))
        return socket;
    }
  return std::nullopt;
}

bool reaches(std::uint32_t possible_crtcs, std::size_t index) {
  return index < 32 && (possible_crtcs >> index & 1U) != 0;
}

// The one that shows on this connector already, so that the screen need not go dark; else one that
// nobody uses; else any.
std::optional<std::size_t> choose_crtc(const Card& card, const Connector& connector) {
  const auto used_elsewhere = [&](std::uint32_t crtc) {
    return std::ranges::any_of(card.connectors, [&](const Connector& other) {
      return other.id != connector.id && other.current_crtc == crtc;
    });
  };
  std::optional<std::size_t> free;
  std::optional<std::size_t> any;
  for (std::size_t i = 0; i < card.crtcs.size(); ++i) {
    if (!reaches(connector.possible_crtcs, i))
      continue;
    if (card.crtcs[i] == connector.current_crtc)
      return i;
    if (!any)
      any = i;
    if (!free && !used_elsewhere(card.crtcs[i]))
      free = i;
  }
  return free ? free : any;
}

std::uint32_t choose_plane(const Card& card, std::size_t crtc_index) {
  const std::uint32_t crtc = card.crtcs[crtc_index];
  const Plane* free = nullptr;
  for (const Plane& plane : card.planes) {
    if (plane.kind != PlaneKind::primary || !reaches(plane.possible_crtcs, crtc_index))
      continue;
    if (plane.current_crtc == crtc)
      return plane.id;
    if (free == nullptr && plane.current_crtc == 0)
      free = &plane;
  }
  return free != nullptr ? free->id : 0;
}

} // namespace

Result<OutputChoice> choose_output(std::span<const Card> cards, const OutputRequest& wanted) {
  if (sockets_of(cards, "").empty())
    return no_card(cards);
  const auto socket = choose_socket(cards, wanted.connector);
  if (!socket)
    return nothing_connected(cards, wanted.connector);

  const Card& card = cards[socket->card];
  const Connector& connector = at(cards, *socket);
  const auto crtc = choose_crtc(card, connector);
  if (!crtc)
    return fail(ErrorCode::unsupported,
                "kms display: nothing in {} ({}) can send a picture to {}, expected a CRTC; use "
                "another connector: {}",
                card.node, card.driver, connector.name, list_of(cards));
  auto mode = choose_mode(connector.modes, wanted.mode);
  if (!mode)
    return fail(mode.error().code, "{} ({})", mode.error().message, connector.name);

  OutputChoice choice;
  choice.card = socket->card;
  choice.connector = socket->connector;
  choice.crtc = card.crtcs[*crtc];
  choice.plane = choose_plane(card, *crtc);
  choice.atomic = wanted.atomic && card.atomic && choice.plane != 0;
  choice.mode = *std::move(mode);
  return choice;
}

std::vector<std::uint32_t> common_formats(const Plane* plane,
                                          std::span<const std::uint32_t> drawable) {
  constexpr std::array<std::uint32_t, 4> wanted{DRM_FORMAT_XRGB8888, DRM_FORMAT_XBGR8888,
                                                DRM_FORMAT_ARGB8888, DRM_FORMAT_ABGR8888};
  const auto shows = [&](std::uint32_t format) {
    if (plane == nullptr || plane->formats.empty())
      return format == DRM_FORMAT_XRGB8888;
    return std::ranges::find(plane->formats, format) != plane->formats.end();
  };
  std::vector<std::uint32_t> common;
  for (const std::uint32_t format : wanted)
    if (shows(format) && std::ranges::find(drawable, format) != drawable.end())
      common.push_back(format);
  return common;
}

std::vector<std::uint64_t> usable_modifiers(const Card& card, const Plane* plane,
                                            std::uint32_t format) {
  std::vector<std::uint64_t> usable;
  if (!card.modifiers || plane == nullptr)
    return usable;
  for (const FormatModifier& pair : plane->modifiers)
    if (pair.format == format && pair.modifier != DRM_FORMAT_MOD_INVALID)
      usable.push_back(pair.modifier);
  return usable;
}

const Plane* find_plane(const Card& card, std::uint32_t id) {
  for (const Plane& plane : card.planes)
    if (plane.id == id)
      return &plane;
  return nullptr;
}

} // namespace octascope::hal::linux_backend::kms
