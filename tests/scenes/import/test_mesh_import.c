#include "scenes/import/mesh_import.h"

#include <assimp/cimport.h>
#include <errno.h>
#include <fcntl.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/prctl.h>
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
  const abbe_result result = abbe_mesh_import(PATH, NULL, mesh, NULL, &error);
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

/* The import that the child calls (tests/scenes.cmake), where it is to hang: it waits, and takes no
 * processor time. */
static bool hangs;
static int told[2]; /* the child's number goes through here */
const struct aiScene *__real_aiImportFileExWithProperties(const char *path, unsigned flags,
                                                          struct aiFileIO *io,
                                                          const struct aiPropertyStore *store);
const struct aiScene *__wrap_aiImportFileExWithProperties(const char *path, unsigned flags,
                                                          struct aiFileIO *io,
                                                          const struct aiPropertyStore *store);
const struct aiScene *__wrap_aiImportFileExWithProperties(const char *path, unsigned flags,
                                                          struct aiFileIO *io,
                                                          const struct aiPropertyStore *store) {
  const pid_t self = getpid();
  if (hangs && write(told[1], &self, sizeof self) == sizeof self)
    for (;;) pause();
  return __real_aiImportFileExWithProperties(path, flags, io, store);
}

/* The alarm that it sets: a second for all that it has. */
unsigned __real_alarm(unsigned seconds);
unsigned __wrap_alarm(unsigned seconds);
unsigned __wrap_alarm(unsigned seconds) {
  return __real_alarm(hangs && seconds > 0 ? 1 : seconds);
}

static void a_child_that_waits_for_ever_is_ended(void **state) {
  (void)state;
  abbe_mesh m;
  sigset_t blocked, before;
  assert_int_equal(pipe(told), 0);
  sigemptyset(&blocked);
  sigaddset(&blocked, SIGALRM); /* as a caller may have */
  sigprocmask(SIG_BLOCK, &blocked, &before);
  hangs = true;
  assert_int_equal(import(HEADER "0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n", &m), ABBE_PARSE);
  hangs = false;
  sigprocmask(SIG_SETMASK, &before, NULL);
  assert_non_null(strstr(error.text, "assimp finds no end of it"));
  assert_no_child_is_left();
  close(told[0]);
  close(told[1]);
}

/* This process inherits the children of those that it started. */
static void the_child_dies_with_its_caller(void **state) {
  (void)state;
  abbe_mesh m;
  pid_t grandchild = 0;
  int status = 0;
  assert_int_equal(prctl(PR_SET_CHILD_SUBREAPER, 1), 0);
  assert_int_equal(pipe(told), 0);
  const pid_t caller = fork();
  if (caller == 0) {
    hangs = true;
    __real_alarm(0);
    _exit(import(HEADER "0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n", &m) == ABBE_OK);
  }
  assert_int_equal(read(told[0], &grandchild, sizeof grandchild), sizeof grandchild);
  assert_int_equal(kill(caller, SIGKILL), 0);
  assert_int_equal(waitpid(caller, &status, 0), caller);
  assert_int_equal(waitpid(grandchild, &status, 0), grandchild);
  assert_true(WIFSIGNALED(status));
  assert_int_equal(WTERMSIG(status), SIGKILL);
  assert_int_equal(prctl(PR_SET_CHILD_SUBREAPER, 0), 0);
  close(told[0]);
  close(told[1]);
  unlink(PATH);
}

static void without_a_pipe_it_says_so(void **state) {
  (void)state;
  abbe_mesh m;
  struct rlimit limit;
  const int next = dup(STDIN_FILENO);
  close(next);
  assert_int_equal(getrlimit(RLIMIT_NOFILE, &limit), 0);
  assert_int_equal(setrlimit(RLIMIT_NOFILE, &(struct rlimit){(rlim_t)next, limit.rlim_max}), 0);
  const abbe_result result = abbe_mesh_import("any.obj", NULL, &m, NULL, &error);
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
      cmocka_unit_test(a_child_that_waits_for_ever_is_ended),
      cmocka_unit_test(the_child_dies_with_its_caller),
      cmocka_unit_test(without_a_pipe_it_says_so),
      cmocka_unit_test(without_a_process_it_says_so),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
