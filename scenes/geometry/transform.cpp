// The GLM bridge of transform.h: no logic, no exception past it.
#include "scenes/geometry/transform.h"

#include <cmath>
#include <cstring>

#include <glm/glm.hpp>
#include <glm/gtc/matrix_inverse.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

namespace {

glm::dmat4 matrix(const double m[16]) {
  return glm::make_mat4(m);
}
glm::dvec3 vector(const double v[3]) {
  return glm::make_vec3(v);
}

void store(const glm::dmat4 &m, double out[16]) {
  std::memcpy(out, glm::value_ptr(m), 16 * sizeof(double));
}
void store(const glm::dvec3 &v, double out[3]) {
  std::memcpy(out, glm::value_ptr(v), 3 * sizeof(double));
}

} // namespace

extern "C" {

void abbe_transform_identity(double out[16]) {
  store(glm::dmat4(1.0), out);
}

void abbe_transform_multiply(const double a[16], const double b[16], double out[16]) {
  store(matrix(a) * matrix(b), out);
}

void abbe_transform_translate(const double offset[3], double out[16]) {
  store(glm::translate(glm::dmat4(1.0), vector(offset)), out);
}

void abbe_transform_scale(const double factor[3], double out[16]) {
  store(glm::scale(glm::dmat4(1.0), vector(factor)), out);
}

void abbe_transform_rotate(double angle_rad, const double axis[3], double out[16]) {
  store(glm::rotate(glm::dmat4(1.0), angle_rad, vector(axis)), out);
}

void abbe_transform_look_at(const double eye[3], const double target[3], const double up[3],
                            double out[16]) {
  const glm::dvec3 forward = vector(target) - vector(eye);
  glm::dvec3 side = glm::cross(forward, vector(up));
  glm::dvec3 upward = vector(up);
  if (!(glm::length(side) > 1e-9 * glm::length(forward) * glm::length(upward))) {
    upward = std::fabs(forward.y) > 0.9 * glm::length(forward) ? glm::dvec3(1, 0, 0)
                                                               : glm::dvec3(0, 1, 0);
  }
  store(glm::lookAtRH(vector(eye), vector(target), upward), out);
}

void abbe_transform_perspective(double left, double right, double bottom, double top, double near,
                                double far, double out[16]) {
  store(glm::frustumRH_NO(left * near, right * near, bottom * near, top * near, near, far), out);
}

void abbe_transform_orthographic(double left, double right, double bottom, double top, double near,
                                 double far, double out[16]) {
  store(glm::orthoRH_NO(left, right, bottom, top, near, far), out);
}

bool abbe_transform_inverse(const double m[16], double out[16]) {
  const glm::dmat4 inverse = glm::inverse(matrix(m));
  for (int i = 0; i < 16; i++)
    if (!std::isfinite(glm::value_ptr(inverse)[i])) return false;
  store(inverse, out);
  return true;
}

bool abbe_transform_normal_matrix(const double m[16], double out[9]) {
  const glm::dmat3 normal = glm::inverseTranspose(glm::dmat3(matrix(m)));
  for (int i = 0; i < 9; i++)
    if (!std::isfinite(glm::value_ptr(normal)[i])) return false;
  std::memcpy(out, glm::value_ptr(normal), 9 * sizeof(double));
  return true;
}

void abbe_transform_point(const double m[16], const double p[3], double out[3]) {
  const glm::dvec4 moved = matrix(m) * glm::dvec4(vector(p), 1.0);
  store(glm::dvec3(moved) / moved.w, out);
}

void abbe_transform_direction(const double m[16], const double d[3], double out[3]) {
  store(glm::dmat3(matrix(m)) * vector(d), out);
}

double abbe_transform_determinant3(const double m[16]) {
  return glm::determinant(glm::dmat3(matrix(m)));
}

} // extern "C"
