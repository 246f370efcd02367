// The one place that includes EGL and GLES headers.
#pragma once

#ifndef EGL_NO_X11
#define EGL_NO_X11
#endif
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GLES3/gl31.h>
// After gl31.h: extensions build on its types.
#include <GLES2/gl2ext.h>
