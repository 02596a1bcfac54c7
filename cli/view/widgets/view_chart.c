#include "cli/view/widgets/view_chart.h"

#include "base/number.h"
#include "cli/view/widgets/view_ui.h"
#include "colorimetry/chromaticity.h"
#include "colorimetry/rgb_space.h"

#include <math.h>

#define FRAME 0x3a404a
#define DIM 0x858b95
#define LINE 0xd6d9de
#define REC709 0x9aa3b2
#define ACESCG 0x6b7482
#define OTHER 0xffb86b

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

static double height_of(double value, double most, double high) {
  return isfinite(value) ? high * fmin(1, fmax(0, value) / most) : 0;
}

static void draw_spread(double x, double base, double value, double spread, double most,
                        double high, abbe_ui_colour colour) {
  if (!(spread > 0)) return;
  abbe_ui_line(x, base - height_of(value - spread, most, high), x,
               base - height_of(value + spread, most, high), colour, 1);
}

void abbe_view_chart_spectrum(const abbe_view_chart_bands *b) {
  const double width = abbe_ui_panel_width(), height = 120, foot = 18;
  double x, y, most = 0;
  char text[96];
  if (!abbe_ui_place("spectrum", width, height, &x, &y)) return;
  const double base = y + height - foot, high = height - foot - 16;
  for (size_t i = 0; i < b->count; i++)
    if (isfinite(b->value[i]))
      most = fmax(most, b->value[i] + (isfinite(b->error[i]) ? b->error[i] : 0));
  const double from = b->nm[0], to = b->nm[b->count - 1];
  const double step = b->count > 1 ? width / (double)b->count : width;
  const double between = step > 3 ? 0.5 : 0;
  abbe_ui_line(x, base, x + width, base, FRAME, 1);
  if (!(most > 0) || !(to >= from)) return;
  for (size_t i = 0; i < b->count; i++) {
    const double left = x + step * (double)i, middle = left + 0.5 * step;
    abbe_ui_box(left + between, base - height_of(b->value[i], most, high), left + step - between,
                base, hue_of(b->nm[i]));
    if (b->deviation != NULL)
      draw_spread(middle - 1, base, b->value[i], b->deviation[i], most, high, DIM);
    draw_spread(middle, base, b->value[i], b->error[i], most, high, LINE);
  }
  abbe_number_format(text, sizeof text, "%.3g %.60s", most, b->unit);
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

static void draw_diagram(const frame *f, const double (*xy)[2], size_t count,
                         const double (*cloud)[2], size_t cloud_count) {
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
  for (size_t i = 0; i < cloud_count; i++) {
    dot_of(f, cloud[i], at);
    abbe_ui_circle(at[0], at[1], 1, LINE, 1);
  }
  for (size_t i = count; i-- > 0;) {
    dot_of(f, xy[i], at);
    abbe_ui_circle(at[0], at[1], 4, i == 0 ? 0xffffff : OTHER, 2);
  }
}

void abbe_view_chart_colours(const double (*xy_of)[2], size_t count, const double (*cloud)[2],
                             size_t cloud_count) {
  const double width = abbe_ui_panel_width(), half = 0.5 * width, high = half, foot = 20;
  double x, y;
  if (!abbe_ui_place("chromaticity", width, high + foot, &x, &y)) return;
  const frame xy = {x + 4, y + high - 4, (high - 10) / 0.86, false};
  const frame uv = {x + half + 6, y + high - 4, (high - 10) / 0.64, true};
  draw_diagram(&xy, xy_of, count, cloud, cloud_count);
  draw_diagram(&uv, xy_of, count, cloud, cloud_count);
  abbe_ui_label(x + half - 32, y + 2, DIM, "x, y");
  abbe_ui_label(x + width - 38, y + 2, DIM, "u', v'");
  abbe_ui_label(x, y + high + 2, REC709, "Rec.709");
  abbe_ui_label(x + half, y + high + 2, ACESCG, "ACEScg");
}

void abbe_view_chart_histogram(const size_t *bin, size_t count, const char *least,
                               const char *most) {
  const double width = abbe_ui_panel_width(), high = 60, step = width / (double)count;
  double x, y, greatest = 1;
  if (!abbe_ui_place("histogram", width, high + 18, &x, &y)) return;
  for (size_t k = 0; k < count; k++) greatest = fmax(greatest, (double)bin[k]);
  for (size_t k = 0; k < count; k++)
    abbe_ui_box(x + step * (double)k, y + high * (1 - sqrt((double)bin[k] / greatest)),
                x + step * (double)(k + 1), y + high, DIM);
  abbe_ui_label(x, y + high + 2, DIM, least);
  abbe_ui_label(x + width - 50, y + high + 2, DIM, most);
}
