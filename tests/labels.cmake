# What each test is to CTest, by its name: the one place that says so, and which sanitizer runs what.
# Read by CTest for each program of tests (tests/CMakeLists.txt), with `program`, the program's name,
# test_${program}_TESTS, the names of its tests (none where it is not built), `random`, what draws
# random input, `executable` and `environment`, and `sanitized_by`, asan or tsan in a build for sanitizers.
#
#   unit     of one module and quick: all of them take less than two minutes
#   slow     of one module; takes seconds, or draws many pictures
#   program  the built program, as a user runs it, and what is installed with it
#   device   of a backend or of a twin, beside what else it is
#   clock    keeps to a real clock: runs alone, and alone may be tried a second time
#   random   draws random input, from a seed of its own unless OCTASCOPE_TEST_SEED says otherwise
#
# In a build for sanitizers, `asan` and `tsan` are suites of those tests that it runs: see below.
#
# Expressions fit the beginning of a name, which is module.suite.test, with what GoogleTest adds to
# suites and tests that have parameters.

cmake_minimum_required(VERSION 3.25)

# Real sweeps of hundreds of milliseconds, frames that must be taken in time, pictures that must not be
# marked as late, those of a moment after the start, and of a pedal's script that ends with the run. What only waits for something to come is no clock's.
set(clock
  "aravis_camera\\.Genicam/LineCamera.*Contract\\."
  "pipeline_threads\\."
  "twins\\.sim/.*Contract\\..*/real_time"
  "v4l2_camera\\..*/real_time"
  "program\\.(Controls\\.a_pedal|LiveFlow\\.every|NoFault\\.|Scripts/ShownFaults\\.|Window\\.)")

# Aravis's fake camera has one port: who waits for it waits in its own time (loopback_port.h).
set(genicam_port "aravis_camera\\.Genicam" "program_genicam\\.")

set(slow
  "aravis_camera\\.GenicamCamera\\.(ends_soon|frames_with_lost|one_that_is_not_there|two_hundred)"
  "aravis_camera\\.GenicamCameraStart\\."
  "aravis_camera\\.Genicam/LineCameraLoansContract\\.(a_disconnect|another_thread)"
  "vessel_following\\."
  "bidirectional\\."
  "coronary_tree\\."
  "firmware_host\\.(BenchReconstruct|EveryKey|LiveTreeLoop|Proof|ReplayLoop|Staleness|UpperBorderOf|VesselLoaderTest)\\."
  "firmware_host\\.(Phantoms|Scenes|Techniques)/"
  "pipeline\\.(all/InputTypes|ScanLagEstimator|ReconstructorRealData)\\."
  "ui\\.(Allocation|EverySize|GoldenLayout|GoldenPicture|HudInAllLayouts|HudInAllSizes|HudPicture)\\."
  "ui\\.(Isas/RayCasterIsa|LegendPicture|StereoPicture|Techniques/|VolumePainterTest)"
  "ui\\.(VolumeTechniquesTest|Vessel(Agreement|FlightTest|Merging|Methods|OverlayTest|Splatter))\\.")

set(device "aravis(_camera)?\\." "hal(_[a-z]+)?\\." "sim\\." "twins\\." "v4l2(_camera)?\\." "window_display\\.")

# Sanitizers run what is quick; of what is slow, threads that nothing quick has; and of the built program
# every fault at once, ends by a signal, a replay, and what is refused.
set(sanitized
  "aravis_camera\\."
  "program_genicam\\.GenicamRun\\.shows"
  "coronary_tree\\."
  "firmware_host\\.(LiveTreeLoop|ReplayLoop|Staleness|VesselLoaderTest)\\."
  "firmware_host\\.Techniques/LostDisplay\\..*/surface"
  "program\\.(All/RefusedReplay|Everything|LedgerAfterASignal|ReplayProgram|Run|Signals/RunEnds)\\."
  "ui\\.Vessel(Methods|OverlayTest|Splatter)\\."
  "ui\\.VolumePainterTest\\.")
# Minutes, for threads of which others have the same.
set(not_tsan
  "coronary_tree\\.(NearestApproach|SegmentGrid)"
  "live_tree\\.FollowedVesselsTest\\."
  "sim\\.(FlowTruth|MovingTissue|PerfusedTissue)\\."
  "sim\\.RepeatedSweeps\\.(come_with|tissue)"
  "sim\\.VolumeLoop\\.(comes_round|impossible|lines_stay|surfaces|the_beam)"
  "ui\\.Buffers/EveryChange\\.")
# Tracings that take as long as their trees may be old, by a clock that does not wait for them.
set(not_asan "live_tree\\.FollowedVesselsTest\\.")

# Of pictures, traced scenes, moving samples, generated trees and long series some are enough: what is there
# to find by a sanitizer is in each of them, and the others show what is right in numbers.
set(alike
  "angiography\\.BScanFlow\\.repeats_that"
  "angiography\\.Motions/MovingSample\\.vessels_are_told"
  "coronary_tree\\.CoronaryTree\\.(declares|feeds|follows|has|is_another|joins|keeps|shows|stays|tells_how)"
  "firmware_host\\.(Calliper\\.measures|CalibrateCommand\\.tissue)"
  "sim\\.(PerfusedTissue\\.is_about|RepeatedSweeps\\.a_beam|VolumeLoop\\.tissue)"
  "soak\\.RandomFaults\\.are_never_refused"
  "ui\\.Buffers/EveryChange\\.(gives|with)"
  "ui\\.Glance\\.every_word_has_contrast"
  "ui\\.Isas/.*SSE4"
  "ui\\.Modes/GrainTest\\."
  "ui\\.Phantom/PhantomSections\\..*/(anterior_eye|perfused)"
  "ui\\.ShownFlow\\.is_there_or_not"
  "ui\\.VesselOverlayTest\\.(a_uniform_volume|where_there_is)"
  "ui\\.VesselSmoothing\\.(a_wide|halves|outlines|within)"
  "ui\\.VolumePainterTest\\.(a_corner|a_cut|draws_again|processor_shader|says_that|sees_through)"
  "ui\\.Ways/RenewedPicture\\..*/(0|2|4|5|6|8|9|10|12|13|15)$"
  "vessel_tracing\\.Scenes/VesselTracerScenes\\..*/(0|1|2|3|5|6|7|8|9|10)$"
  "vessel_tracing\\.VesselTracerTree\\.(bridges|joins|leaves_out|may_be_stopped|reaches|takes_less)")

# Does one of the expressions fit the name?
function(octascope_fits variable name)
  set(${variable} FALSE PARENT_SCOPE)
  foreach(expression IN LISTS ARGN)
    if(name MATCHES "^(${expression})")
      set(${variable} TRUE PARENT_SCOPE)
      return()
    endif()
  endforeach()
endfunction()

set(suites) # what the sanitizer runs: a suite is one process, as each takes long to begin and to end
foreach(test IN LISTS test_${program}_TESTS)
  octascope_fits(is_slow "${test}" ${slow})
  octascope_fits(is_sanitized "${test}" ${sanitized})
  if(program MATCHES "^program")
    set(labels program)
  elseif(is_slow)
    set(labels slow)
  else()
    set(labels unit)
    set(is_sanitized TRUE)
  endif()
  octascope_fits(has_port "${test}" ${genicam_port})
  octascope_fits(is_clock "${test}" ${clock})
  if(sanitized_by)
    octascope_fits(is_left_out "${test}" ${not_${sanitized_by}} ${alike})
    if(is_sanitized AND NOT is_left_out)
      string(REGEX MATCH "[^.]+[.][^.]+$" filter "${test}")
      string(REGEX MATCH "^[^.]+[.][^.]+" suite "${test}")
      if(is_clock)
        string(APPEND suite ".by_the_clock")
      endif()
      list(APPEND suites "${suite}")
      string(APPEND "filter_${suite}" "${filter}:")
      math(EXPR "tests_${suite}" "${tests_${suite}} + 1")
      set("port_${suite}" ${has_port})
      set("clock_${suite}" ${is_clock})
    endif()
    continue()
  endif()
  foreach(label device random)
    octascope_fits(is_${label} "${test}" ${${label}})
  endforeach()
  foreach(label clock device random)
    if(is_${label})
      list(APPEND labels ${label})
    endif()
  endforeach()
  set_tests_properties("${test}" PROPERTIES LABELS "${labels}" RUN_SERIAL ${is_clock})
  if(has_port)
    set_tests_properties("${test}" PROPERTIES RESOURCE_LOCK genicam_port)
  endif()
endforeach()

list(REMOVE_DUPLICATES suites)
foreach(suite IN LISTS suites)
  add_test("${suite}" "${executable}" "--gtest_filter=${filter_${suite}}")
  set(labels ${sanitized_by})
  if("${clock_${suite}}")
    list(APPEND labels clock)
  endif()
  set_tests_properties("${suite}" PROPERTIES LABELS "${labels}" RUN_SERIAL "${clock_${suite}}"
    COST "${tests_${suite}}" TIMEOUT 900 ENVIRONMENT "${environment}")
  if("${port_${suite}}")
    set_tests_properties("${suite}" PROPERTIES RESOURCE_LOCK genicam_port)
  endif()
endforeach()

# An expression that fits nothing has been left behind by a test that has another name now.
if(test_${program}_TESTS AND NOT sanitized_by)
  foreach(expression IN LISTS clock slow sanitized not_tsan not_asan)
    string(REGEX MATCH "^[a-z0-9_]+" module "${expression}")
    set(fitting ${test_${program}_TESTS})
    list(FILTER fitting INCLUDE REGEX "^(${expression})")
    if(module STREQUAL program AND NOT fitting)
      message(FATAL_ERROR "no test of test_${program} fits \"${expression}\"")
    endif()
  endforeach()
endif()
