#include "gl/wyman2006/wyman_photons.h"

#include "scenes/geometry/vector.h"

#include <stdio.h>

/* The plane of the largest receiver, where that is flat; else of its face. */
static void find_background(const abbe_gpu_scene *scene, double out[4]) {
  double most = 0;
  for (size_t i = 0; i < scene->plan->receiver_count; i++) {
    const abbe_mesh *mesh = &scene->local->object[scene->plan->receiver_object[i]].mesh;
    for (size_t f = 0; f < mesh->face_count; f++) {
      const double *corner = mesh->position[mesh->face[f][0]];
      double u[3], v[3], n[3];
      abbe_vector_subtract(mesh->position[mesh->face[f][1]], corner, u);
      abbe_vector_subtract(mesh->position[mesh->face[f][2]], corner, v);
      abbe_vector_cross(u, v, n);
      const double area = abbe_vector_length(n);
      if (area <= most) continue;
      most = area;
      for (int k = 0; k < 3; k++) out[k] = n[k] / area;
      out[3] = abbe_vector_dot(out, corner);
    }
  }
}

static abbe_result make_program(abbe_wyman_photons *p, const abbe_shader_variant *variant,
                                const char *definitions, abbe_error *error) {
  static const abbe_program_stage stages[] = {{GL_VERTEX_SHADER, "screen.vert"},
                                              {GL_FRAGMENT_SHADER, "wyman_photons.frag"}};
  const abbe_render_desc *d = &p->scene->plan->desc;
  char text[1024];
  const int length =
      snprintf(text, sizeof text,
               "%s#define ESTIMATOR %d\n#define ITERATIONS %zu\n#define OBJECT_FACES %zu\n%s",
               definitions, (int)d->estimator, d->iterations, p->light->object_faces,
               p->light->faces > 1 ? "#define PLACES_CUBE\n" : "");
  if (length < 0 || (size_t)length >= sizeof text)
    return abbe_error_set(error, ABBE_GL, "a shader's definitions are too long");
  return abbe_shader_variant_program(variant, p->scene->gpu, stages, 2, text, &p->program, error);
}

abbe_result abbe_wyman_photons_make(const abbe_gpu_scene *scene, const abbe_image_places *light,
                                    const abbe_shader_variant *variant, const char *definitions,
                                    abbe_wyman_photons *out, abbe_error *error) {
  const size_t side = scene->plan->desc.photons;
  const GLenum format =
      abbe_profile_is_printed(scene->plan->desc.profile) ? GL_RGBA16F : GL_RGBA32F;
  *out = (abbe_wyman_photons){.scene = scene, .light = light};
  find_background(scene, out->background);
  abbe_result result =
      abbe_gpu_make_texture(scene->gpu, format, side, side, 0, false, &out->places, error);
  if (result == ABBE_OK)
    result = abbe_gpu_make_texture(scene->gpu, format, side, side, 0, false, &out->incident, error);
  return result == ABBE_OK ? make_program(out, variant, definitions, error) : result;
}

void abbe_wyman_photons_free(abbe_wyman_photons *p) {
  if (p->scene == NULL) return;
  abbe_gpu_drop_textures(p->scene->gpu, 1, &p->places);
  abbe_gpu_drop_textures(p->scene->gpu, 1, &p->incident);
  *p = (abbe_wyman_photons){0};
}

abbe_result abbe_wyman_photons_run(const abbe_wyman_photons *p, size_t wavelength, size_t face,
                                   abbe_error *error) {
  static const int flat[2] = {-1, -1};
  const abbe_gpu_scene *scene = p->scene;
  const abbe_gl *gl = scene->gpu->gl;
  const size_t side = scene->plan->desc.photons;
  const GLuint targets[2] = {p->places, p->incident};
  abbe_result result = abbe_gpu_set_target(scene->gpu, targets, flat, 2, 0, side, side, error);
  if (result != ABBE_OK) return result;
  gl->Disable(GL_DEPTH_TEST);
  gl->UseProgram(p->program);
  abbe_gpu_scene_set(scene, p->program);
  abbe_image_places_set(p->light, p->program);
  abbe_image_view_set_lamp(scene, p->program, scene->local->light[0].direction);
  abbe_gpu_set_int(scene->gpu, p->program, "wavelength", (int)wavelength);
  abbe_gpu_set_int(scene->gpu, p->program, "object_face", (int)face);
  abbe_gpu_set_float(scene->gpu, p->program, "object_bias", 1e-3 * scene->refractor_radius);
  gl->Uniform4f(gl->GetUniformLocation(p->program, "mirror_plane"), (float)p->background[0],
                (float)p->background[1], (float)p->background[2], (float)p->background[3]);
  abbe_gpu_draw_screen(scene->gpu);
  return ABBE_OK;
}
