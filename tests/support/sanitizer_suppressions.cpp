// Complaints of the sanitizers about libraries that are not ours and not instrumented. Code of ours
// is never listed here.
#ifdef OCTASCOPE_SANITIZED

extern "C" const char* __tsan_default_suppressions();
extern "C" const char* __tsan_default_options();
extern "C" const char* __lsan_default_suppressions();

// Mesa's software rasteriser synchronises its threads by bare futexes, which the thread sanitizer
// cannot see.
extern "C" const char* __tsan_default_suppressions() {
  return "called_from_lib:swrast_dri.so\n"
         "race:swrast_dri.so\n"
         "race:libLLVM\n";
}

// It holds more locks at once than the deadlock detector can count, which then ends the program.
extern "C" const char* __tsan_default_options() {
  return "detect_deadlocks=0";
}

// HDF5 forgets some memory of damaged files that it refuses; that nothing is left open, tests see. SDL keeps its connections to the desktop for the life of the process; Mesa its driver.
extern "C" const char* __lsan_default_suppressions() {
  return "leak:H5FL__malloc\n"
         "leak:libdbus-1.so\n"
         "leak:libSDL2\n"
         "leak:libX11\n"
         "leak:swrast_dri.so\n";
}

#endif
