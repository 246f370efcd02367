// What a formula needs to compile for the host and for CUDA.
#pragma once

#include "core/device.h"
