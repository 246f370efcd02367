// The one place that includes GLM.
#pragma once

#ifdef __CUDACC__
// GLM marks its defaulted functions for the device, which is not needed.
#pragma nv_diagnostic push
#pragma nv_diag_suppress 20012
#endif
#include <glm/glm.hpp>
#ifdef __CUDACC__
#pragma nv_diagnostic pop
#endif
