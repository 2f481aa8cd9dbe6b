// The steps of a commissioning, in their order.
#pragma once

#include "firmware-host/commands/commission/dialogue.h"
#include "firmware-host/commands/commission/session.h"
#include "hal/clock.h"
#include "hal/result.h"

namespace octascope::firmware_host {

// What a step works with. Bound to one thread.
struct Bench {
  Session& session;
  Dialogue& dialogue;
  hal::Clock& clock;
};

// Each asks, measures, and returns what it found; values for later steps are set in the session.
hal::Result<StepRecord> find_camera(Bench& bench);
hal::Result<StepRecord> count_trigger(Bench& bench);
hal::Result<StepRecord> look_at_spectrum(Bench& bench);
hal::Result<StepRecord> capture_dark(Bench& bench);
hal::Result<StepRecord> capture_near_mirror(Bench& bench);
hal::Result<StepRecord> capture_far_mirror(Bench& bench);
hal::Result<StepRecord> capture_tissue(Bench& bench);
hal::Result<StepRecord> calibrate_from_captures(Bench& bench);
hal::Result<StepRecord> check_target(Bench& bench);
hal::Result<StepRecord> learn_pedal(Bench& bench);
hal::Result<StepRecord> write_configuration(Bench& bench);

// Asks that something be laid under the beam. With the twin: what it shall look at, `phantom` unless
// another one is named. Returns the phantom.
hal::Result<std::string> ask_to_place(Bench& bench, const std::string& what,
                                      const std::string& phantom);

// A whole volume of raw spectra, to a new file.
hal::Result<std::filesystem::path> capture_volume(Bench& bench, std::string_view stem,
                                                  const std::string& phantom);

} // namespace octascope::firmware_host
