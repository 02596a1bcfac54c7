#include "gl/device/program.h"

#include <assert.h>
#include <ctype.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_FILES = 64, MAX_STAGES = 4 };

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
  ABBE_TRY(set_line(s, 1, file, error));
  for (int line = 1; *text != '\0'; line++) {
    size_t size = strcspn(text, "\n");
    size += text[size] == '\n';
    char included[64];
    if (sscanf(text, "#include \"%63[^\"]\"", included) == 1) {
      const char *known = NULL;
      for (size_t i = 0; abbe_shader_files[i].name != NULL; i++)
        if (strcmp(abbe_shader_files[i].name, included) == 0) known = abbe_shader_files[i].name;
      ABBE_TRY(include_file(s, known != NULL ? known : included, error));
      ABBE_TRY(set_line(s, line + 1, file, error));
    } else {
      ABBE_TRY(append(s, text, size, error));
    }
    text += size;
  }
  return ABBE_OK;
}

/* ---- definitions ---- */

typedef struct definition {
  const char *line, *name, *value;
  size_t size, name_size; /* length of the line, with its end */
  bool wanted;
} definition;

enum { MAX_DEFINITIONS = 160 };

static bool in_word(char c) {
  return c == '_' || isalnum((unsigned char)c);
}

static definition read_definition(const char *line) {
  static const char begin[] = "#define ";
  definition d = {.line = line, .size = strcspn(line, "\n")};
  d.size += line[d.size] == '\n';
  d.wanted = strncmp(line, begin, sizeof begin - 1) != 0;
  if (d.wanted) return d;
  d.name = d.value = line + sizeof begin - 1;
  while (in_word(*d.value)) d.value++;
  d.name_size = (size_t)(d.value - d.name);
  return d;
}

/* Those that the text mentions, and those that these mention. */
static void want(definition *list, size_t count, const char *text, const char *end) {
  while (text < end) {
    const char *word = text;
    while (text < end && in_word(*text)) text++;
    const size_t size = (size_t)(text - word);
    for (size_t i = 0; size > 0 && i < count; i++) {
      definition *d = &list[i];
      if (d->wanted || d->name_size != size || memcmp(d->name, word, size) != 0) continue;
      d->wanted = true;
      want(list, count, d->value, d->line + d->size);
    }
    if (size == 0) text++;
  }
}

/* A driver knows what it has compiled by its text. So a program has only those definitions that it
 * mentions, and is not compiled anew where others change. */
static abbe_result append_definitions(source *s, const char *defines, const source *files,
                                      abbe_error *error) {
  definition list[MAX_DEFINITIONS];
  size_t count = 0;
  for (const char *at = defines; at != NULL && *at != '\0'; at += list[count++].size) {
    if (count == MAX_DEFINITIONS)
      return abbe_error_set(error, ABBE_GL, "a shader has more than %d definitions",
                            MAX_DEFINITIONS);
    list[count] = read_definition(at);
  }
  want(list, count, files->text, files->text + files->size);
  for (size_t i = 0; i < count; i++)
    if (list[i].wanted) ABBE_TRY(append(s, list[i].line, list[i].size, error));
  return ABBE_OK;
}

/* The text of one stage, of a file or given. */
static abbe_result write_text(const char *file, const char *text, const char *defines, source *out,
                              abbe_error *error) {
  static const char version[] = "#version 450 core\n", bindings[] = "bindings.h";
  source files = {.file = {bindings}, .files = 1};
  abbe_result result = append(out, version, sizeof version - 1, error);
  if (result == ABBE_OK) result = include_file(out, bindings, error);
  if (result == ABBE_OK)
    result = text != NULL ? expand(&files, file, text, error) : include_file(&files, file, error);
  if (result == ABBE_OK) result = append_definitions(out, defines, &files, error);
  if (result == ABBE_OK) result = append(out, files.text, files.size, error);
  free(files.text);
  return result;
}

static abbe_result compile(const abbe_gl *gl, GLenum type, const char *file, const char *text,
                           const char *defines, GLuint *out, abbe_error *error) {
  source s = {0};
  abbe_result result = write_text(file, text, defines, &s, error);
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
  assert(gl->CreateShader);
  return make(gl, stages, NULL, count, defines, out, error);
}

abbe_result abbe_program_make_compute(const abbe_gl *gl, const char *file, const char *defines,
                                      GLuint *out, abbe_error *error) {
  assert(gl->CreateShader);
  abbe_program_stage stage = {GL_COMPUTE_SHADER, file};
  return make(gl, &stage, NULL, 1, defines, out, error);
}

abbe_result abbe_program_make_compute_text(const abbe_gl *gl, const char *text, const char *defines,
                                           GLuint *out, abbe_error *error) {
  assert(gl->CreateShader);
  abbe_program_stage stage = {GL_COMPUTE_SHADER, "text"};
  return make(gl, &stage, text, 1, defines, out, error);
}

abbe_result abbe_program_text(const char *file, const char *defines, char **out,
                              abbe_error *error) {
  source s = {0};
  const abbe_result result = write_text(file, NULL, defines, &s, error);
  *out = s.text;
  if (result == ABBE_OK) return ABBE_OK;
  free(s.text);
  *out = NULL;
  return result;
}

const char *const *abbe_program_files(void) {
  static const char *names[256];
  for (size_t i = 0; abbe_shader_files[i].name != NULL && i < 255; i++)
    names[i] = abbe_shader_files[i].name;
  return names;
}
