#include "gl/device/program.h"

#include "gl/device/shader_files.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_FILES = 48, MAX_STAGES = 4 };

/* Source being put together; files are numbered as #line knows them. */
typedef struct source {
  char *text;
  size_t size, capacity;
  const char *file[MAX_FILES];
  int files;
} source;

static abbe_result append(source *s, const char *text, size_t size, abbe_error *error) {
  if (s->size + size + 1 > s->capacity) {
    size_t capacity = (s->size + size + 1) * 2;
    char *grown = realloc(s->text, capacity);
    if (grown == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a shader");
    s->text = grown;
    s->capacity = capacity;
  }
  memcpy(s->text + s->size, text, size);
  s->size += size;
  s->text[s->size] = '\0';
  return ABBE_OK;
}

static const char *find_file(const char *name) {
  for (size_t i = 0; abbe_shader_files[i].name != NULL; i++)
    if (strcmp(abbe_shader_files[i].name, name) == 0)
      return (const char *)abbe_shader_files[i].text;
  return NULL;
}

static abbe_result expand(source *s, const char *name, const char *text, abbe_error *error);

static abbe_result include_file(source *s, const char *name, abbe_error *error) {
  for (int i = 0; i < s->files; i++)
    if (strcmp(s->file[i], name) == 0) return ABBE_OK;
  const char *text = find_file(name);
  if (text == NULL)
    return abbe_error_set(error, ABBE_NOT_FOUND, "there is no shader file '%s'", name);
  return expand(s, name, text, error);
}

static abbe_result set_line(source *s, int line, int file, abbe_error *error) {
  char text[64];
  int size = snprintf(text, sizeof text, "#line %d %d\n", line, file);
  return append(s, text, (size_t)size, error);
}

static abbe_result expand(source *s, const char *name, const char *text, abbe_error *error) {
  if (s->files == MAX_FILES)
    return abbe_error_set(error, ABBE_GL, "shader '%s' includes too many files", name);
  int file = s->files++;
  s->file[file] = name;
  abbe_result result = set_line(s, 1, file, error);
  for (int line = 1; result == ABBE_OK && *text != '\0'; line++) {
    size_t size = strcspn(text, "\n");
    size += text[size] == '\n';
    char included[64];
    if (sscanf(text, "#include \"%63[^\"]\"", included) == 1) {
      const char *known = NULL;
      for (size_t i = 0; abbe_shader_files[i].name != NULL; i++)
        if (strcmp(abbe_shader_files[i].name, included) == 0) known = abbe_shader_files[i].name;
      result = include_file(s, known != NULL ? known : included, error);
      if (result == ABBE_OK) result = set_line(s, line + 1, file, error);
    } else {
      result = append(s, text, size, error);
    }
    text += size;
  }
  return result;
}

static abbe_result compile(const abbe_gl *gl, GLenum type, const char *file, const char *text,
                           const char *defines, GLuint *out, abbe_error *error) {
  static const char version[] = "#version 450 core\n";
  source s = {0};
  abbe_result result = append(&s, version, sizeof version - 1, error);
  if (result == ABBE_OK) result = include_file(&s, "bindings.h", error);
  if (result == ABBE_OK && defines != NULL) result = append(&s, defines, strlen(defines), error);
  if (result == ABBE_OK)
    result = text != NULL ? expand(&s, file, text, error) : include_file(&s, file, error);
  if (result != ABBE_OK) {
    free(s.text);
    return result;
  }
  GLuint shader = gl->CreateShader(type);
  const GLchar *lines = s.text;
  gl->ShaderSource(shader, 1, &lines, NULL);
  gl->CompileShader(shader);
  GLint compiled = GL_FALSE;
  gl->GetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
  if (compiled != GL_TRUE) {
    char log[700] = "";
    gl->GetShaderInfoLog(shader, sizeof log, NULL, log);
    result = abbe_error_set(error, ABBE_GL, "shader '%s' does not compile: %s", file, log);
    gl->DeleteShader(shader);
    shader = 0;
  }
  free(s.text);
  *out = shader;
  return result;
}

static abbe_result link(const abbe_gl *gl, GLuint *shaders, size_t count, const char *name,
                        GLuint *out, abbe_error *error) {
  GLuint program = gl->CreateProgram();
  for (size_t i = 0; i < count; i++) gl->AttachShader(program, shaders[i]);
  gl->LinkProgram(program);
  GLint linked = GL_FALSE;
  gl->GetProgramiv(program, GL_LINK_STATUS, &linked);
  if (linked == GL_TRUE) {
    *out = program;
    return ABBE_OK;
  }
  char log[700] = "";
  gl->GetProgramInfoLog(program, sizeof log, NULL, log);
  gl->DeleteProgram(program);
  return abbe_error_set(error, ABBE_GL, "program '%s' does not link: %s", name, log);
}

static abbe_result make(const abbe_gl *gl, const abbe_program_stage *stages, const char *text,
                        size_t count, const char *defines, GLuint *out, abbe_error *error) {
  GLuint shaders[MAX_STAGES] = {0};
  abbe_result result = ABBE_OK;
  *out = 0;
  if (count == 0 || count > MAX_STAGES)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "a program has 1 to %d stages", MAX_STAGES);
  for (size_t i = 0; i < count && result == ABBE_OK; i++)
    result = compile(gl, stages[i].type, stages[i].file, text, defines, &shaders[i], error);
  if (result == ABBE_OK) result = link(gl, shaders, count, stages[count - 1].file, out, error);
  for (size_t i = 0; i < count; i++)
    if (shaders[i] != 0) gl->DeleteShader(shaders[i]);
  return result;
}

abbe_result abbe_program_make(const abbe_gl *gl, const abbe_program_stage *stages, size_t count,
                              const char *defines, GLuint *out, abbe_error *error) {
  ABBE_REQUIRE(gl && gl->CreateShader && stages && out, error);
  return make(gl, stages, NULL, count, defines, out, error);
}

abbe_result abbe_program_make_compute(const abbe_gl *gl, const char *file, const char *defines,
                                      GLuint *out, abbe_error *error) {
  ABBE_REQUIRE(gl && gl->CreateShader && file && out, error);
  abbe_program_stage stage = {GL_COMPUTE_SHADER, file};
  return make(gl, &stage, NULL, 1, defines, out, error);
}

abbe_result abbe_program_make_compute_text(const abbe_gl *gl, const char *text, const char *defines,
                                           GLuint *out, abbe_error *error) {
  ABBE_REQUIRE(gl && gl->CreateShader && text && out, error);
  abbe_program_stage stage = {GL_COMPUTE_SHADER, "text"};
  return make(gl, &stage, text, 1, defines, out, error);
}

const char *const *abbe_program_files(void) {
  static const char *names[256];
  for (size_t i = 0; abbe_shader_files[i].name != NULL && i < 255; i++)
    names[i] = abbe_shader_files[i].name;
  return names;
}
