// Signed distance [px] of a texel of the distance transform.
float edtDistance(vec4 texel) {
  float root = sqrt(abs(texel.z));
  return texel.z < 0.0 ? -root : root;
}
