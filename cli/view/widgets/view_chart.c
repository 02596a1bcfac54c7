#include "cli/view/widgets/view_chart.h"

#include "base/number.h"
#include "cli/view/widgets/view_ui.h"
#include "colorimetry/chromaticity.h"
#include "colorimetry/rgb_space.h"

#include <math.h>
#include <stdio.h>

#define FRAME 0x3a404a
#define DIM 0x858b95
#define LINE 0xd6d9de
#define REC709 0x9aa3b2
#define ACESCG 0x6b7482

/* About the colour of light of one wavelength, as bright as a screen can. */
static abbe_ui_colour hue_of(double nm) {
  double xyz[3], rgb[3], matrix[9], most = 1e-9;
  unsigned byte[3];
  abbe_observer_xyz(nm, xyz);
  abbe_rgb_space_from_xyz(ABBE_RGB_SPACE_REC709, matrix);
  abbe_rgb_space_apply(matrix, xyz, rgb);
  for (int k = 0; k < 3; k++) most = fmax(most, rgb[k]);
  for (int k = 0; k < 3; k++)
    byte[k] = (unsigned)(235 * pow(fmin(1, fmax(0.02, rgb[k] / most)), 1 / 2.2) + 20);
  return byte[0] << 16 | byte[1] << 8 | byte[2];
}

void abbe_view_chart_spectrum(const abbe_view_probe *p) {
  const double width = abbe_ui_panel_width(), height = 120, foot = 18;
  double x, y, most = 0;
  char text[64];
  if (!abbe_ui_place("spectrum", width, height, &x, &y)) return;
  const double base = y + height - foot, high = height - foot - 16;
  for (size_t i = 0; i < p->bands; i++) most = fmax(most, p->radiance[i] + p->stderr_of[i]);
  const double from = p->nm[0], to = p->nm[p->bands - 1];
  const double step = p->bands > 1 ? width / (double)p->bands : width;
  abbe_ui_line(x, base, x + width, base, FRAME, 1);
  if (!(most > 0) || !(to > from)) return;
  for (size_t i = 0; i < p->bands; i++) {
    const double left = x + step * (double)i, middle = left + 0.5 * step;
    const double top = base - high * fmax(0, p->radiance[i]) / most;
    const double low = base - high * fmax(0, p->radiance[i] - p->stderr_of[i]) / most;
    const double up = base - high * (p->radiance[i] + p->stderr_of[i]) / most;
    abbe_ui_box(left + 0.5, top, left + step - 0.5, base, hue_of(p->nm[i]));
    abbe_ui_line(middle, low, middle, up, LINE, 1);
  }
  abbe_number_format(text, sizeof text, "%.3g W/(m\u00b2 sr nm), \u00b1 1 standard error", most);
  abbe_ui_label(x, y - 2, DIM, text);
  abbe_number_format(text, sizeof text, "%.0f", from);
  abbe_ui_label(x, base + 2, DIM, text);
  abbe_number_format(text, sizeof text, "%.0f nm", to);
  abbe_ui_label(x + width - 52, base + 2, DIM, text);
}

/* A diagram: of x, y or of u', v'. */
typedef struct frame {
  double x, y, scale;
  bool uniform;
} frame;

static void dot_of(const frame *f, const double xy[2], double out[2]) {
  double at[2] = {xy[0], xy[1]};
  if (f->uniform) abbe_chromaticity_uv_of_xy(xy, at);
  out[0] = f->x + f->scale * at[0];
  out[1] = f->y - f->scale * at[1];
}

static void side(const frame *f, const double a[2], const double b[2], abbe_ui_colour colour) {
  double p[2], q[2];
  dot_of(f, a, p);
  dot_of(f, b, q);
  abbe_ui_line(p[0], p[1], q[0], q[1], colour, 1.2);
}

static void gamut(const frame *f, abbe_rgb_space space, abbe_ui_colour colour) {
  double xy[8];
  abbe_rgb_space_chromaticities(space, xy);
  for (int k = 0; k < 3; k++) side(f, &xy[2 * k], &xy[2 * ((k + 1) % 3)], colour);
}

static void draw_diagram(const frame *f, const abbe_view_probe *p) {
  static const double white[2] = {0.31272, 0.32903};
  double at[2], a[2], b[2];
  for (int nm = 400; nm < 700; nm += 5) {
    abbe_chromaticity_locus(ABBE_OBSERVER_CIE_1931, nm, a);
    abbe_chromaticity_locus(ABBE_OBSERVER_CIE_1931, nm + 5, b);
    side(f, a, b, hue_of(nm));
  }
  abbe_chromaticity_locus(ABBE_OBSERVER_CIE_1931, 400, a);
  abbe_chromaticity_locus(ABBE_OBSERVER_CIE_1931, 700, b);
  side(f, a, b, 0x8a5a8a);
  gamut(f, ABBE_RGB_SPACE_ACESCG, ACESCG);
  gamut(f, ABBE_RGB_SPACE_REC709, REC709);
  dot_of(f, white, at);
  abbe_ui_circle(at[0], at[1], 2, DIM, 1);
  dot_of(f, p->xy, at);
  abbe_ui_circle(at[0], at[1], 4, 0xffffff, 2);
}

void abbe_view_chart_colours(const abbe_view_probe *p) {
  const double width = abbe_ui_panel_width(), half = 0.5 * width, high = half, foot = 20;
  double x, y;
  if (!abbe_ui_place("chromaticity", width, high + foot, &x, &y)) return;
  const frame xy = {x + 4, y + high - 4, (high - 10) / 0.86, false};
  const frame uv = {x + half + 6, y + high - 4, (high - 10) / 0.64, true};
  draw_diagram(&xy, p);
  draw_diagram(&uv, p);
  abbe_ui_label(x + half - 32, y + 2, DIM, "x, y");
  abbe_ui_label(x + width - 38, y + 2, DIM, "u', v'");
  abbe_ui_label(x, y + high + 2, REC709, "Rec.709");
  abbe_ui_label(x + half, y + high + 2, ACESCG, "ACEScg");
}
