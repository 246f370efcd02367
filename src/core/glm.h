// The one place that includes GLM.
#pragma once

#include <glm/glm.hpp>
