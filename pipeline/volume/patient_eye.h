// The patient and the eye, as given by the user; either may be unknown.
#pragma once

#include <string>

#include "pipeline/volume/eye.h"

namespace octascope::pipeline {

struct PatientEye {
  std::string subject; // empty: not said
  Eye eye = Eye::not_said;

  bool said() const { return !subject.empty() || eye != Eye::not_said; }
  bool operator==(const PatientEye&) const = default;
};

// False where the subject or the eye is known in both and differs.
inline bool may_be_same(const PatientEye& a, const PatientEye& b) {
  const bool subjects = a.subject.empty() || b.subject.empty() || a.subject == b.subject;
  const bool eyes = a.eye == Eye::not_said || b.eye == Eye::not_said || a.eye == b.eye;
  return subjects && eyes;
}

} // namespace octascope::pipeline
