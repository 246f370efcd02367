// Errors: what a library function throws when it cannot do its work.
#pragma once

#include <stdexcept>
#include <string>

namespace rangepose {

/// Something is wrong with the input or the work failed (command line: exit code 1).
/// The text is one line: what, where (file, field, index), what to do.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A back-end (EGL, CUDA) is not available on this machine (command line: exit code 3).
class Unavailable : public Error {
 public:
  using Error::Error;
};

namespace detail {
[[noreturn]] void failCheck(const char* expression, const std::string& message);
}  // namespace detail

}  // namespace rangepose

/// Precondition of a public function: throws Error with the message when it does not hold.
#define RP_CHECK(condition, message)                                         \
  do {                                                                       \
    if (!(condition)) ::rangepose::detail::failCheck(#condition, (message)); \
  } while (false)
