/* matrix3.h: products and inverses of row-major 3x3 matrices. */
#ifndef ABBE_COLORIMETRY_MATRIX3_H
#define ABBE_COLORIMETRY_MATRIX3_H

/* out = a * b; out is neither. */
static inline void abbe_matrix3_multiply(const double a[9], const double b[9], double out[9]) {
  for (int row = 0; row < 3; row++)
    for (int column = 0; column < 3; column++) {
      double sum = 0;
      for (int k = 0; k < 3; k++) sum += a[3 * row + k] * b[3 * k + column];
      out[3 * row + column] = sum;
    }
}

/* By cofactors; of a singular matrix nothing finite. out is not m. */
static inline void abbe_matrix3_invert(const double m[9], double out[9]) {
  const double c[9] = {
      m[4] * m[8] - m[5] * m[7], m[2] * m[7] - m[1] * m[8], m[1] * m[5] - m[2] * m[4],
      m[5] * m[6] - m[3] * m[8], m[0] * m[8] - m[2] * m[6], m[2] * m[3] - m[0] * m[5],
      m[3] * m[7] - m[4] * m[6], m[1] * m[6] - m[0] * m[7], m[0] * m[4] - m[1] * m[3]};
  const double determinant = m[0] * c[0] + m[1] * c[3] + m[2] * c[6];
  for (int i = 0; i < 9; i++) out[i] = c[i] / determinant;
}

#endif
