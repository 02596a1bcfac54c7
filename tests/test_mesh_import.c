#include "scenes/mesh_import.h"

#include <errno.h>
#include <fcntl.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

#define PATH "t_import.ply"
#define HEADER                                                                                     \
  "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"                  \
  "property float z\nelement face 3\nproperty list uchar int vertex_indices\nend_header\n"         \
  "0 0 0\n1 0 0\n0 1 0\n"

static abbe_error error;

static abbe_result import(const char *text, abbe_mesh *mesh) {
  FILE *f = fopen(PATH, "wb");
  assert_non_null(f);
  assert_int_equal(fwrite(text, 1, strlen(text), f), strlen(text));
  assert_int_equal(fclose(f), 0);
  error.text[0] = '\0';
  const abbe_result result = abbe_mesh_import(PATH, strlen(text), mesh, &error);
  unlink(PATH);
  return result;
}

static void assert_no_child_is_left(void) {
  assert_int_equal(waitpid(-1, NULL, WNOHANG), -1);
  assert_int_equal(errno, ECHILD);
}

static void reads_triangles_and_polygons(void **state) {
  (void)state;
  abbe_mesh m;
  assert_int_equal(import(HEADER "0 0 1\n3 0 2 1\n4 0 1 2 3\n3 0 3 2\n", &m), ABBE_OK);
  assert_int_equal(m.vertex_count, 4);
  assert_int_equal(m.face_count, 4);
  assert_true(m.position[3][2] == 1 && m.position[3][0] == 0 && m.position[1][0] == 1);
  assert_int_equal(m.face[0][1], 2);
  abbe_mesh_free(&m);
  assert_no_child_is_left();
}

static void not_called(int number) {
  (void)number;
  fail_msg("the caller's handler ran");
}

static void a_file_that_stops_assimp_ends_a_child(void **state) {
  (void)state;
  abbe_mesh m;
  void (*before)(int) = signal(SIGABRT, not_called);
  assert_int_equal(import(HEADER "0 0 0.1\n0 2 1\n3 0 1 3\n3 0 3 2\n", &m), ABBE_PARSE);
  signal(SIGABRT, before);
  assert_non_null(strstr(error.text, PATH ": the mesh cannot be read: assimp stops at it"));
  assert_null(m.position);
  assert_no_child_is_left();
}

static void a_file_that_assimp_finds_no_end_of_ends_a_child(void **state) {
  (void)state;
  abbe_mesh m;
  assert_int_equal(import(HEADER "1 0 0.1\n0 2 1\n3 0 1 3\n3 0 3 2\n", &m), ABBE_PARSE);
  assert_non_null(strstr(error.text, PATH ": the mesh cannot be read: assimp"));
  assert_null(m.face);
  assert_no_child_is_left();
}

static void a_caller_that_leaves_children_to_the_system_is_served(void **state) {
  (void)state;
  abbe_mesh m;
  void (*before)(int) = signal(SIGCHLD, SIG_IGN);
  assert_int_equal(import(HEADER "0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n", &m), ABBE_OK);
  abbe_mesh_free(&m);
  assert_int_equal(import(HEADER "0 0 0.1\n0 2 1\n3 0 1 3\n3 0 3 2\n", &m), ABBE_PARSE);
  signal(SIGCHLD, before);
}

static void no_file_is_left_open(void **state) {
  (void)state;
  abbe_mesh m;
  const int next = dup(STDIN_FILENO);
  close(next);
  for (int i = 0; i < 3; i++) {
    assert_int_equal(import(HEADER "0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n", &m), ABBE_OK);
    abbe_mesh_free(&m);
    assert_int_equal(import("ply\nnothing", &m), ABBE_PARSE);
  }
  const int now = dup(STDIN_FILENO);
  close(now);
  assert_int_equal(now, next);
}

static void a_caller_without_standard_streams_is_served(void **state) {
  (void)state;
  abbe_mesh m;
  int kept[2];
  fflush(stdout);
  for (int fd = 0; fd < 2; fd++) {
    kept[fd] = fcntl(fd, F_DUPFD, 10);
    assert_true(kept[fd] >= 10);
  }
  for (int fd = 0; fd < 2; fd++) close(fd);
  const abbe_result result = import(HEADER "0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n", &m);
  for (int fd = 0; fd < 2; fd++) {
    dup2(kept[fd], fd);
    close(kept[fd]);
  }
  assert_int_equal(result, ABBE_OK);
  abbe_mesh_free(&m);
}

static void without_a_pipe_it_says_so(void **state) {
  (void)state;
  abbe_mesh m;
  struct rlimit limit;
  const int next = dup(STDIN_FILENO);
  close(next);
  assert_int_equal(getrlimit(RLIMIT_NOFILE, &limit), 0);
  assert_int_equal(setrlimit(RLIMIT_NOFILE, &(struct rlimit){(rlim_t)next, limit.rlim_max}), 0);
  const abbe_result result = abbe_mesh_import("any.obj", 1, &m, &error);
  assert_int_equal(setrlimit(RLIMIT_NOFILE, &limit), 0);
  assert_int_equal(result, ABBE_IO);
  assert_non_null(strstr(error.text, "any.obj: there is no pipe"));
}

/* The fork that abbe_mesh_import calls (tests/scenes.cmake). */
static bool no_process; /* the system has none to give */
static int refused;
pid_t __real_fork(void);
pid_t __wrap_fork(void);
pid_t __wrap_fork(void) {
  if (!no_process) return __real_fork();
  refused++;
  errno = EAGAIN;
  return -1;
}

static void without_a_process_it_says_so(void **state) {
  (void)state;
  abbe_mesh m;
  const char *text = HEADER "0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n";
  const int next = dup(STDIN_FILENO);
  close(next);
  no_process = true;
  refused = 0;
  for (int i = 1; i <= 3; i++) {
    memset(&m, 0xff, sizeof m);
    assert_int_equal(import(text, &m), ABBE_IO);
    assert_int_equal(refused, i);
    assert_string_equal(error.text, PATH ": there is no process to read the mesh in: "
                                         "Resource temporarily unavailable");
    assert_null(m.position);
    assert_null(m.face);
    assert_int_equal(m.vertex_count + m.face_count, 0);
  }
  no_process = false;
  const int now = dup(STDIN_FILENO);
  close(now);
  assert_int_equal(now, next);
  assert_no_child_is_left();
  assert_int_equal(import(text, &m), ABBE_OK);
  abbe_mesh_free(&m);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(reads_triangles_and_polygons),
      cmocka_unit_test(a_file_that_stops_assimp_ends_a_child),
      cmocka_unit_test(a_file_that_assimp_finds_no_end_of_ends_a_child),
      cmocka_unit_test(a_caller_that_leaves_children_to_the_system_is_served),
      cmocka_unit_test(no_file_is_left_open),
      cmocka_unit_test(a_caller_without_standard_streams_is_served),
      cmocka_unit_test(without_a_pipe_it_says_so),
      cmocka_unit_test(without_a_process_it_says_so),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
