#include "hal/linux/hid/models/control_model.h"

#include <fmt/format.h>
#include <linux/input-event-codes.h>

namespace octascope::hal::linux_backend {

namespace {

struct UsbId {
  std::uint16_t vendor, product;
};

// One foot switch, or three in a row that say so in their product's name and type a, b and c as
// they leave the factory.
void add_pcsensor(std::vector<ControlModel>& models) {
  constexpr UsbId single_or_triple[]{
      {0x0c45, 0x7404}, {0x413d, 0x2107}, {0x3553, 0xb001}, {0x1a86, 0xe026}, {0x0c45, 0x7403}};
  for (const UsbId& id : single_or_triple)
    models.push_back({.vendor = id.vendor,
                      .product = id.product,
                      .model = "pcsensor_triple",
                      .name = "PCsensor triple foot switch",
                      .family = HidFamily::keyboard,
                      .switches = 3,
                      .product_has = "FootSwitch3",
                      .keys = {KEY_A, KEY_B, KEY_C}});
  for (const UsbId& id : single_or_triple)
    models.push_back({.vendor = id.vendor,
                      .product = id.product,
                      .model = "pcsensor_single",
                      .name = "PCsensor foot switch",
                      .family = HidFamily::keyboard,
                      .switches = 1});
}

void add_shuttles(std::vector<ControlModel>& models) {
  for (const auto [vendor, product] : {UsbId{0x0b33, 0x0030}, UsbId{0x0b33, 0x0010}})
    models.push_back({.vendor = vendor,
                      .product = product,
                      .model = "shuttle_pro",
                      .name = product == 0x0030 ? "Contour ShuttlePro v2" : "Contour ShuttlePro",
                      .family = HidFamily::shuttle,
                      .switches = 15,
                      .knobs = 1});
  models.push_back({.vendor = 0x0b33,
                    .product = 0x0020,
                    .model = "shuttle_xpress",
                    .name = "Contour ShuttleXpress",
                    .family = HidFamily::shuttle,
                    .switches = 5,
                    .knobs = 1,
                    .first_button = 4});
}

} // namespace

std::vector<ControlModel> listed_control_models() {
  std::vector<ControlModel> models{{.vendor = 0x05f3,
                                    .product = 0x00ff,
                                    .model = "vec_infinity",
                                    .name = "VEC Infinity IN-USB-2 pedal",
                                    .family = HidFamily::vec_pedal,
                                    .switches = 3}};
  for (const auto [vendor, product] : {UsbId{0x0911, 0x1844}, UsbId{0x0911, 0x091a}})
    models.push_back(
        {.vendor = vendor,
         .product = product,
         .model = "philips_pedal",
         .name = product == 0x1844 ? "Philips ACC2310/2320 pedal" : "Philips ACC2330 pedal",
         .family = HidFamily::philips_pedal,
         .switches = 4});
  add_pcsensor(models);
  for (const auto [vendor, product] : {UsbId{0x077d, 0x0410}, UsbId{0x077d, 0x04aa}})
    models.push_back({.vendor = vendor,
                      .product = product,
                      .model = "powermate",
                      .name = "Griffin PowerMate",
                      .family = HidFamily::powermate,
                      .switches = 1,
                      .knobs = 1});
  models.push_back({.vendor = 0x045e,
                    .product = 0x091b,
                    .model = "surface_dial",
                    .name = "Microsoft Surface Dial",
                    .family = HidFamily::surface_dial,
                    .switches = 1,
                    .knobs = 1});
  add_shuttles(models);
  for (const UsbId& id : {UsbId{0x046d, 0xc626}, UsbId{0x256f, 0xc62e}})
    models.push_back({.vendor = id.vendor,
                      .product = id.product,
                      .model = "space_mouse",
                      .name = id.vendor == 0x046d ? "3Dconnexion SpaceNavigator"
                                                  : "3Dconnexion SpaceMouse Wireless",
                      .family = HidFamily::space_mouse,
                      .switches = 2});
  return models;
}

std::string usb_id(std::uint16_t vendor, std::uint16_t product) {
  return fmt::format("{:04x}:{:04x}", vendor, product);
}

} // namespace octascope::hal::linux_backend
