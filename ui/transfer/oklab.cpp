#include "ui/transfer/oklab.h"

#include <cmath>

namespace octascope::ui {

namespace {

float encoded(float linear) {
  return linear <= 0.0031308F ? 12.92F * linear : 1.055F * std::pow(linear, 1 / 2.4F) - 0.055F;
}

float linear(float encoded) {
  return encoded <= 0.04045F ? encoded / 12.92F : std::pow((encoded + 0.055F) / 1.055F, 2.4F);
}

float cubed(float x) {
  return x * x * x;
}

} // namespace

TransferTable::Colour to_srgb(const Oklab& lab) {
  const float l = cubed(lab.lightness + 0.3963377774F * lab.a + 0.2158037573F * lab.b);
  const float m = cubed(lab.lightness - 0.1055613458F * lab.a - 0.0638541728F * lab.b);
  const float s = cubed(lab.lightness - 0.0894841775F * lab.a - 1.2914855480F * lab.b);
  return {encoded(4.0767416621F * l - 3.3077115913F * m + 0.2309699292F * s),
          encoded(-1.2684380046F * l + 2.6097574011F * m - 0.3413193965F * s),
          encoded(-0.0041960863F * l - 0.7034186147F * m + 1.7076147010F * s)};
}

Oklab to_oklab(const TransferTable::Colour& srgb) {
  const float red = linear(srgb.red);
  const float green = linear(srgb.green);
  const float blue = linear(srgb.blue);
  const float l = std::cbrt(0.4122214708F * red + 0.5363325363F * green + 0.0514459929F * blue);
  const float m = std::cbrt(0.2119034982F * red + 0.6806995451F * green + 0.1073969566F * blue);
  const float s = std::cbrt(0.0883024619F * red + 0.2817188376F * green + 0.6299787005F * blue);
  return {0.2104542553F * l + 0.7936177850F * m - 0.0040720468F * s,
          1.9779984951F * l - 2.4285922050F * m + 0.4505937099F * s,
          0.0259040371F * l + 0.7827717662F * m - 0.8086757660F * s};
}

} // namespace octascope::ui
