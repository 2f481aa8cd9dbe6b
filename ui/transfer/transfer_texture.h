// The transfer function as a texture.
#pragma once

namespace octascope::ui {

class TransferTexture {};

} // namespace octascope::ui
