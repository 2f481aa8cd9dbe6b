// What the two ways of octascope vessels register share: from pairs of points, and from trees.
#pragma once

#include <filesystem>
#include <string>

#include "pipeline/vessels/registration.h"

namespace octascope::firmware_host {

struct VesselsRegisterCommandLine {
  std::filesystem::path points;          // or the two below
  std::filesystem::path tree, to, start; // `start` may be empty
  std::filesystem::path out;
  std::string author;
  std::string subject, eye;
  bool accept_misfit = false; // of points
  bool json = false;
};

// With what the command line says of it, and the time; `provenance` has the rest.
pipeline::Registration registration_for(const VesselsRegisterCommandLine& line,
                                        const pipeline::RigidTransform& volume_from_tree,
                                        pipeline::RegistrationProvenance provenance);

// The exit status.
int register_trees(const VesselsRegisterCommandLine& line);

} // namespace octascope::firmware_host
