#pragma once
// Checks for bugs, as opposed to errors in the user's data (gloam/result.h). A failed check prints
// and aborts.

namespace gloam {
[[noreturn]] void check_failed(const char* file, int line, const char* condition,
                               const char* message);
}

/// Always on: an invariant of the program.
#define GLOAM_CHECK(condition, message) \
  ((condition) ? (void)0 : ::gloam::check_failed(__FILE__, __LINE__, #condition, message))

/// For hot paths: on in dev and sanitizer builds only.
#ifdef GLOAM_DCHECKS
#define GLOAM_DCHECK(condition, message) GLOAM_CHECK(condition, message)
#else
#define GLOAM_DCHECK(condition, message) ((void)0)
#endif
