/* The picture as a texture: what abbe_renderer_read reads, where it was drawn. */
#include "tests/gl/frame.h"

#include "colorimetry/rgb_space.h"

static abbe_renderer_picture get_texture(abbe_renderer *renderer) {
  abbe_renderer_picture out;
  OK(abbe_renderer_texture(renderer, &out, &error));
  return out;
}

/* The texture by glGetTexImage, its rows turned over, its scale and space applied. */
static void assert_is_the_picture(abbe_renderer *renderer, bool distances) {
  abbe_image image = {0};
  read_picture(renderer, distances, &image);
  const abbe_renderer_picture p = get_texture(renderer);
  const abbe_gl *gl = abbe_context_gl(context);
  assert_true(p.texture != 0);
  assert_int_equal(p.width, image.width);
  assert_int_equal(p.height, image.height);
  assert_true(image_max(&image, 1) > 0);
  float *texel = malloc(p.width * p.height * 4 * sizeof *texel);
  assert_non_null(texel);
  gl->BindTexture(GL_TEXTURE_2D, p.texture);
  gl->GetTexImage(GL_TEXTURE_2D, 0, GL_RGBA, GL_FLOAT, texel);
  OK(abbe_gl_check(gl, "the test", &error));
  double matrix[9];
  abbe_rgb_space_to_xyz(p.space, matrix);
  for (size_t y = 0; y < p.height; y++)
    for (size_t x = 0; x < p.width; x++) {
      const float *from = texel + ((p.height - 1 - y) * p.width + x) * 4;
      const float *to = image.data + (y * p.width + x) * image.channels;
      double v[3] = {from[0], from[1], from[2]};
      if (strcmp(image.channel[0], "X") == 0) abbe_rgb_space_apply(matrix, v, v);
      for (int c = 0; c < 3; c++) {
        const float scaled = (float)((double)(float)v[c] * p.scale);
        assert_memory_equal(&scaled, &to[c], sizeof scaled);
      }
      if (distances) assert_memory_equal(&from[3], &to[3], sizeof from[3]);
    }
  free(texel);
  abbe_image_free(&image);
}

static void check(const abbe_render_desc *desc, double power, abbe_rgb_space space) {
  abbe_scene scene = {0};
  abbe_renderer_picture early;
  load_text(CAMERA POINT_LIGHT FLOOR BALL("crown"), &scene);
  scene.light[0].power *= power;
  abbe_renderer *renderer = make_renderer(&scene, desc);
  REFUSED(ABBE_INVALID_ARGUMENT, "no frame", abbe_renderer_texture(renderer, &early, &error));
  assert_int_equal(early.texture, 0);
  draw_frame(renderer);
  assert_is_the_picture(renderer, desc->aovs);
  const abbe_renderer_picture p = get_texture(renderer);
  assert_int_equal(p.space, space);
  assert_int_equal(p.scale == 1, power == 1);
  draw_frame(renderer); /* the texture is asked for before the frame that it shows and after it */
  assert_int_equal(get_texture(renderer).texture, p.texture);
  assert_is_the_picture(renderer, desc->aovs);
  abbe_renderer_free(renderer);
  abbe_scene_free(&scene);
}

static const abbe_render_desc tiny = {
    .width = 20, .height = 12, .photons = 16, .map_size = 16, .wavelengths = 3};

GROUP(make_context, free_context);

TEST(it_is_what_is_read_in_every_space) {
  abbe_render_desc desc = tiny;
  desc.aovs = true;
  desc.space = ABBE_RGB_SPACE_REC709;
  check(&desc, 1, ABBE_RGB_SPACE_REC709);
  desc.space = ABBE_RGB_SPACE_ACESCG;
  check(&desc, 1, ABBE_RGB_SPACE_ACESCG);
  desc.space = ABBE_RGB_SPACE_XYZ;
  check(&desc, 1, ABBE_RGB_SPACE_ACESCG);
}

TEST(it_is_what_is_read_resolved_and_enlarged) {
  abbe_render_desc desc = tiny;
  desc.supersample = 2;
  check(&desc, 1, ABBE_RGB_SPACE_ACESCG);
  desc.supersample = 1;
  desc.upsample = 2;
  check(&desc, 1, ABBE_RGB_SPACE_ACESCG);
}

TEST(its_scale_serves_faint_light) {
  check(&tiny, 0x1p-93, ABBE_RGB_SPACE_ACESCG);
}

TEST(the_thesis_has_one) {
  abbe_render_desc desc = tiny;
  desc.wavelengths = 7;
  desc.profile = ABBE_PROFILE_THESIS;
  check(&desc, 1, ABBE_RGB_SPACE_REC709);
  desc.profile = ABBE_PROFILE_THESIS_CIE;
  desc.space = ABBE_RGB_SPACE_XYZ;
  check(&desc, 1, ABBE_RGB_SPACE_ACESCG);
}
