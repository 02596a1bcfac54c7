/* A script that makes the scene in Blender, for Cycles [Cycles]. Its point lights have 4 pi times
 * the intensity as power; surfaces that glow have a strength that is radiance; a spot's blend is
 * the share of 1 - cosine over which a smoothstep fades. Glass of three indices is the sum of
 * three that take red, green and blue. */
#include "scenes/export/export_writing.h"

#include "base/maths.h"
#include "base/number.h"

#include <math.h>

#define SPHERE (4 * ABBE_PI)

/* Cut in pieces, since a compiler need not take longer strings. */
static const char *const functions[] = {
    "import math, os, sys\nimport bpy\nfrom mathutils import Matrix\n\n"
    "HERE = os.path.dirname(os.path.abspath(__file__))\n"
    "scene = bpy.data.scenes.new('abbe')\n"
    "if bpy.context.window:\n    bpy.context.window.scene = scene\n"
    "scene.render.engine = 'CYCLES'\nscene.cycles.samples = 256\n"
    "scene.cycles.max_bounces = 24\nscene.cycles.transmission_bounces = 24\n"
    "scene.cycles.glossy_bounces = 24\n" /* inside a stone too */
    /* what makes pictures smoother or faster, and other than the light is */
    "scene.cycles.use_denoising = False\nscene.cycles.use_adaptive_sampling = False\n"
    "scene.cycles.sample_clamp_direct = 0\nscene.cycles.sample_clamp_indirect = 0\n"
    "scene.cycles.blur_glossy = 0\nscene.cycles.light_sampling_threshold = 0\n"
    "scene.cycles.pixel_filter_type = 'BOX'\nscene.cycles.filter_width = 1\n"
    "scene.cycles.caustics_refractive = True\nscene.cycles.caustics_reflective = True\n"
    "scene.view_settings.view_transform = 'Standard'\n"
    "scene.render.image_settings.file_format = 'OPEN_EXR'\n"
    "scene.render.image_settings.color_depth = '32'\n\n\n",
    "def frame(a, b, c, at):\n"
    "    return Matrix(((a[0], b[0], c[0], at[0]), (a[1], b[1], c[1], at[1]),\n"
    "                   (a[2], b[2], c[2], at[2]), (0, 0, 0, 1)))\n\n\n"
    "def place(name, data, matrix):\n"
    "    it = bpy.data.objects.new(name, data)\n    it.matrix_world = matrix\n"
    "    scene.collection.objects.link(it)\n    return it\n\n\n"
    "def camera(right, up, back, eye, fov, width, height):\n"
    "    data = bpy.data.cameras.new('camera')\n    data.sensor_fit = 'VERTICAL'\n"
    "    data.angle = fov\n    data.clip_start = 1e-4\n    data.clip_end = 1e6\n"
    "    scene.camera = place('camera', data, frame(right, up, back, eye))\n"
    "    scene.render.resolution_x = width\n    scene.render.resolution_y = height\n\n\n",
    "def lamp(kind, name, a, b, back, at, energy, color, cone=0, blend=0):\n"
    "    data = bpy.data.lights.new(name, kind)\n    data.energy = energy\n    data.color = color\n"
    "    if kind == 'SUN':\n        data.angle = 0\n    else:\n        data.shadow_soft_size = 0\n"
    "    if kind == 'SPOT':\n        data.spot_size = 2 * cone\n        data.spot_blend = blend\n"
    "    if hasattr(data.cycles, 'is_caustics_light'):\n"
    "        data.cycles.is_caustics_light = True\n"
    "    place(name, data, frame(a, b, back, at))\n\n\n",
    "def mesh(name, points, faces, normals, uvs, stuff):\n"
    "    data = bpy.data.meshes.new(name)\n    data.from_pydata(points, [], faces)\n"
    "    if uvs:\n        layer = data.uv_layers.new()\n"
    "        for loop in data.loops:\n"
    "            layer.data[loop.index].uv = uvs[loop.vertex_index]\n"
    "    if normals:\n        for face in data.polygons:\n            face.use_smooth = True\n"
    "        if hasattr(data, 'use_auto_smooth'):\n            data.use_auto_smooth = True\n"
    "        data.normals_split_custom_set_from_vertices(normals)\n"
    "    data.materials.append(stuff)\n    data.update()\n"
    "    place(name, data, Matrix.Identity(4))\n\n\n",
    "def begin(name):\n"
    "    stuff = bpy.data.materials.new(name)\n    stuff.use_nodes = True\n"
    "    stuff.node_tree.nodes.clear()\n"
    "    return stuff, stuff.node_tree.nodes, stuff.node_tree.links\n\n\n"
    "def end(nodes, links, shader, socket='Surface', out=None):\n"
    "    out = out or nodes.new('ShaderNodeOutputMaterial')\n"
    "    links.new(shader.outputs[0], out.inputs[socket])\n    return out\n\n\n",
    "def glass(name, indices, absorption):\n"
    "    stuff, nodes, links = begin(name)\n    total = None\n"
    "    for c, n in enumerate(indices):\n"
    "        one = nodes.new('ShaderNodeBsdfGlass')\n"
    "        color = [1, 1, 1, 1] if len(indices) == 1 else [c == 0, c == 1, c == 2, 1]\n"
    "        one.inputs['Color'].default_value = color\n"
    "        one.inputs['Roughness'].default_value = 0\n"
    "        one.inputs['IOR'].default_value = n\n"
    "        if total:\n            both = nodes.new('ShaderNodeAddShader')\n"
    "            links.new(total.outputs[0], both.inputs[0])\n"
    "            links.new(one.outputs[0], both.inputs[1])\n            one = both\n"
    "        total = one\n"
    "    out = end(nodes, links, total)\n"
    "    most = max(absorption)\n"
    "    if most > 0:\n"
    "        inside = nodes.new('ShaderNodeVolumeAbsorption')\n"
    "        inside.inputs['Color'].default_value = [1 - a / most for a in absorption] + [1]\n"
    "        inside.inputs['Density'].default_value = most\n"
    "        end(nodes, links, inside, 'Volume', out)\n"
    "    return stuff\n\n\n",
    "def mirror(name, color, roughness=0):\n"
    "    stuff, nodes, links = begin(name)\n    one = nodes.new('ShaderNodeBsdfGlossy')\n"
    "    one.inputs['Color'].default_value = list(color) + [1]\n"
    "    one.inputs['Roughness'].default_value = roughness\n    end(nodes, links, one)\n"
    "    return stuff\n\n\n"
    "def picture(nodes, links, name, socket, kind):\n"
    "    node = nodes.new(kind)\n    node.image = bpy.data.images.load(os.path.join(HERE, name))\n"
    "    links.new(node.outputs['Color'], socket)\n\n\n"
    "def diffuse(name, color, file=None):\n"
    "    stuff, nodes, links = begin(name)\n    one = nodes.new('ShaderNodeBsdfDiffuse')\n"
    "    one.inputs['Color'].default_value = list(color) + [1]\n"
    "    if file:\n"
    "        picture(nodes, links, file, one.inputs['Color'], 'ShaderNodeTexImage')\n"
    "    end(nodes, links, one)\n    return stuff\n\n\n",
    "def glow(name, color):\n"
    "    stuff, nodes, links = begin(name)\n    one = nodes.new('ShaderNodeEmission')\n"
    "    most = max(color)\n"
    "    one.inputs['Color'].default_value = [c / most for c in color] + [1]\n"
    "    one.inputs['Strength'].default_value = most\n"
    "    black = nodes.new('ShaderNodeBsdfDiffuse')\n"
    "    black.inputs['Color'].default_value = [0, 0, 0, 1]\n"
    "    side = nodes.new('ShaderNodeNewGeometry')\n    mix = nodes.new('ShaderNodeMixShader')\n"
    "    links.new(side.outputs['Backfacing'], mix.inputs[0])\n"
    "    links.new(one.outputs[0], mix.inputs[1])\n"
    "    links.new(black.outputs[0], mix.inputs[2])\n    end(nodes, links, mix)\n"
    "    return stuff\n\n\n",
    "world = bpy.data.worlds.new('abbe')\nscene.world = world\nworld.use_nodes = True\n"
    "sky = world.node_tree.nodes['Background']\n"
    "sky.inputs['Color'].default_value = [0, 0, 0, 1]\n"
    "sky.inputs['Strength'].default_value = 1\n\n"};

/* ---- the scene ---- */

static void tuple(const abbe_export_writing *w, const double v[3]) {
  fputc('(', w->file);
  abbe_export_vector(w->file, v, ", ");
  fputc(')', w->file);
}

static void write_camera(const abbe_export_writing *w) {
  const abbe_camera *c = &w->scene->camera;
  double right[3], up[3], forward[3], back[3];
  abbe_export_camera(c, right, up, forward);
  for (int k = 0; k < 3; k++) back[k] = -forward[k];
  const double *const of[] = {right, up, back, c->eye};
  fputs("camera(", w->file);
  for (int i = 0; i < 4; i++) {
    tuple(w, of[i]);
    fputs(", ", w->file);
  }
  abbe_number_write(w->file, "%.9g, %zu, %zu)\n", c->fov_y_rad, c->width, c->height);
}

static void write_mesh(const abbe_export_writing *w, const char *name, const abbe_mesh *mesh,
                       const double repeat[2], const char *stuff) {
  fprintf(w->file, "mesh('%s', [", name);
  for (size_t i = 0; i < mesh->vertex_count; i++) {
    fputs(i % 4 == 0 ? "\n    " : " ", w->file);
    tuple(w, mesh->position[i]);
    fputc(',', w->file);
  }
  fputs("], [", w->file);
  for (size_t f = 0; f < mesh->face_count; f++)
    fprintf(w->file, "%s(%u, %u, %u),", f % 6 == 0 ? "\n    " : " ", mesh->face[f][0],
            mesh->face[f][1], mesh->face[f][2]);
  if (abbe_export_is_faceted(mesh)) {
    fputs("], None, ", w->file);
  } else {
    fputs("], [", w->file);
    for (size_t i = 0; i < mesh->vertex_count; i++) {
      fputs(i % 4 == 0 ? "\n    " : " ", w->file);
      tuple(w, mesh->normal[i]);
      fputc(',', w->file);
    }
    fputs("], ", w->file);
  }
  if (mesh->uv != NULL && repeat != NULL) {
    fputc('[', w->file);
    for (size_t i = 0; i < mesh->vertex_count; i++)
      abbe_number_write(w->file, "%s(%.9g, %.9g),", i % 6 == 0 ? "\n    " : " ",
                        repeat[0] * mesh->uv[i][0], repeat[1] * mesh->uv[i][1]);
    fputs("], ", w->file);
  } else {
    fputs("None, ", w->file);
  }
  fprintf(w->file, "%s)\n", stuff);
}

static abbe_result write_light(const abbe_export_writing *w, size_t i, abbe_error *error) {
  static const char *const kinds[] = {
      [ABBE_LIGHT_POINT] = "POINT", [ABBE_LIGHT_SPOT] = "SPOT", [ABBE_LIGHT_DIRECTIONAL] = "SUN"};
  const abbe_light *light = &w->scene->light[i];
  char name[ABBE_EXPORT_NAME_SIZE];
  double rgb[3], a[3], b[3], back[3], d[3] = {0, 0, -1};
  abbe_mesh mesh = {0};
  abbe_export_name(name, "l", i, light->name);
  abbe_export_light_rgb(&light->illuminant, rgb);
  if (abbe_light_has_size(light)) {
    for (int c = 0; c < 3; c++) rgb[c] *= light->power;
    fprintf(w->file, "%s = glow('%s', ", name, name);
    tuple(w, rgb);
    fputs(")\n", w->file);
    const abbe_result result = abbe_export_light_mesh(light, &mesh, error);
    if (result == ABBE_OK) write_mesh(w, name, &mesh, NULL, name);
    abbe_mesh_free(&mesh);
    return result;
  }
  if (light->kind != ABBE_LIGHT_POINT)
    for (int k = 0; k < 3; k++) d[k] = light->direction[k];
  for (int k = 0; k < 3; k++) back[k] = -d[k];
  abbe_export_basis(back, a, b);
  const double *const of[] = {a, b, back, light->position};
  fprintf(w->file, "lamp('%s', '%s', ", kinds[light->kind], name);
  for (int k = 0; k < 4; k++) {
    tuple(w, of[k]);
    fputs(", ", w->file);
  }
  abbe_number_write(w->file, "%.9g, ",
                    light->power * (light->kind == ABBE_LIGHT_DIRECTIONAL ? 1 : SPHERE));
  tuple(w, rgb);
  if (light->kind == ABBE_LIGHT_SPOT)
    abbe_number_write(w->file, ", %.9g, %.9g", light->cone_rad,
                      (cos(light->cone_rad - light->soft_rad) - cos(light->cone_rad)) /
                          (1 - cos(light->cone_rad)));
  fputs(")\n", w->file);
  return ABBE_OK;
}

/* Its map has +x in the middle and +y to the left, as Abbe's own. */
static void map_direction(double u, double v, double out[3]) {
  const double phi = 2 * ABBE_PI * (0.5 - u), theta = ABBE_PI * v;
  out[0] = cos(phi) * sin(theta);
  out[1] = sin(phi) * sin(theta);
  out[2] = cos(theta);
}

static abbe_result write_environment(const abbe_export_writing *w, abbe_error *error) {
  fprintf(w->file,
          "picture(world.node_tree.nodes, world.node_tree.links, '%s-environment.exr',\n"
          "        sky.inputs['Color'], 'ShaderNodeTexEnvironment')\n",
          w->files->name);
  const size_t of_map = w->scene->environment->map.width, width = of_map < 2048 ? of_map : 2048;
  return abbe_export_environment(w, width, width / 2, map_direction, error);
}

static void write_glass(const abbe_export_writing *w, size_t i) {
  const abbe_scene_export_glass *g = &w->report->glass[i];
  const double *n = g->index.value;
  char name[ABBE_EXPORT_NAME_SIZE];
  double per_m[3];
  abbe_export_attenuation_rgb(g->material, per_m);
  abbe_export_name(name, "m", i, g->material->name);
  fprintf(w->file, "%s = glass('%s', (", name, name);
  abbe_number_write(w->file, n[0] == n[1] && n[1] == n[2] ? "%.9g,), " : "%.9g, ", n[0]);
  if (n[0] != n[1] || n[1] != n[2]) abbe_number_write(w->file, "%.9g, %.9g), ", n[1], n[2]);
  tuple(w, per_m);
  fputs(")\n", w->file);
}

static abbe_result write_object(const abbe_export_writing *w, size_t i, abbe_error *error) {
  const abbe_object *o = &w->scene->object[i];
  if (o->cloud) return ABBE_OK;
  char name[ABBE_EXPORT_NAME_SIZE], glass[ABBE_EXPORT_NAME_SIZE];
  double rgb[3];
  abbe_result result = ABBE_OK;
  abbe_export_name(name, "o", i, o->name);
  if (o->material != NULL) {
    abbe_export_name(glass, "m", abbe_export_glass_of(w, o->material), o->material->name);
    write_mesh(w, name, &o->mesh, NULL, glass);
    return ABBE_OK;
  }
  if (o->mirror) abbe_export_mirror_rgb(o, rgb);
  fprintf(w->file, "%s = %s('%s', ", name, o->mirror ? "mirror" : "diffuse", name);
  tuple(w, o->mirror ? rgb : o->reflectance);
  if (abbe_brushing_is_rough(&o->brushing)) /* squared it is GGX's alpha there */
    abbe_number_write(w->file, ", %.9g", sqrt(abbe_export_roughness(o)));
  if (o->texture_path != NULL) {
    fprintf(w->file, ", '%s-%s.exr'", w->files->name, name);
    result = abbe_export_texture(w, o, name, error);
  }
  fputs(")\n", w->file);
  write_mesh(w, name, &o->mesh, o->texture_path != NULL ? o->texture_repeat : NULL, name);
  return result;
}

abbe_result abbe_export_blender(const abbe_export_writing *w, abbe_error *error) {
  abbe_result result = ABBE_OK;
  abbe_export_comment(w, "# ", "\n");
  fprintf(w->file,
          "# blender -b -P %s.py -- %s.exr: the picture is radiance in linear Rec.709, in "
          "W/(m2 sr) of white.\n",
          w->files->name, w->files->name);
  for (size_t i = 0; i < sizeof functions / sizeof *functions; i++) fputs(functions[i], w->file);
  write_camera(w);
  for (size_t i = 0; i < w->report->glass_count; i++) write_glass(w, i);
  for (size_t i = 0; i < w->scene->light_count && result == ABBE_OK; i++)
    result = write_light(w, i, error);
  if (result == ABBE_OK && w->scene->environment != NULL) result = write_environment(w, error);
  for (size_t i = 0; i < w->scene->object_count && result == ABBE_OK; i++)
    result = write_object(w, i, error);
  fputs("\nif '--' in sys.argv[:-1]:\n"
        "    scene.render.filepath = os.path.abspath(sys.argv[-1])\n"
        "    bpy.ops.render.render(write_still=True, scene=scene.name)\n",
        w->file);
  return result;
}
