// Sanitized builds keep every library to the end. A window system loads its graphics driver and
// unloads it with the last window; the sanitizers then can no longer tell whose memory it was that
// the driver left behind (address), or end the program (thread).
#ifdef OCTASCOPE_SANITIZED

extern "C" int dlclose(void* library) noexcept;

extern "C" int dlclose(void*) noexcept {
  return 0;
}

#endif
