// A recording's description of itself, for the screen. Pure.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "hal/clock.h"
#include "pipeline/recordings/recording.h"

namespace octascope::firmware_host {

// "eye.h5, volume 12 of 240, at rate 2: phantom eye". `position` counts from 0.
std::string recording_source(const std::filesystem::path& file,
                             const pipeline::RecordingFacts& facts, std::size_t position,
                             std::size_t volumes, double rate);

// "A pause of 1:03 is left out".
std::string pause_words(hal::Duration left_out);

} // namespace octascope::firmware_host
