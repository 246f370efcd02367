// What GL says, as text.
#pragma once

#include <string>

#include "gles/gl.h"

namespace rangepose::gles {

/// glGetString, empty where there is none.
std::string glText(GLenum name);

/// Names of all extensions of the context, space separated.
std::string glExtensions();

const char* glErrorName(GLenum error);

/// Without line breaks, for messages.
std::string oneLine(std::string text);

}  // namespace rangepose::gles
