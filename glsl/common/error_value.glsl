// Eq. 1 from the four sums. Twin of errorValue in src/stages/error_core.h.
const float kWorstError = 1.0e6;

float errorValue(vec4 terms, float lambda_per_px, float area_factor) {
  if (terms.y <= 0.0 || terms.w <= 0.0) return kWorstError;
  RP_PRECISE float value = area_factor * (terms.x / terms.y + lambda_per_px * terms.z / terms.w);
  return value;
}
