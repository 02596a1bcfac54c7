#define _GNU_SOURCE /* RLIMIT_AS of a child */
#include "tests/check.h"

#include "scenes/import/mesh_files.h"

#include <stdbool.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

static char folder[64];

static const char *in_folder(const char *name) {
  static char path[2][128];
  static int turn;
  turn = !turn;
  snprintf(path[turn], sizeof path[turn], "%s/%s", folder, name);
  return path[turn];
}

static void write_file(const char *name, size_t size) {
  FILE *f = fopen(in_folder(name), "wb");
  assert_non_null(f);
  fputs("text", f);
  assert_int_equal(fflush(f), 0);
  assert_int_equal(ftruncate(fileno(f), (off_t)size), 0); /* a hole: it takes no room */
  fclose(f);
}

static int make_folder(void **state) {
  (void)state;
  snprintf(folder, sizeof folder, "/tmp/abbe-test-import-XXXXXX");
  if (mkdtemp(folder) == NULL) return 1;
  write_file("mesh", 4);
  write_file("buffer", 8 << 20);
  write_file("huge", ABBE_MESH_FILES_MOST);
  return mkfifo(in_folder("fifo"), 0600);
}

static int remove_folder(void **state) {
  (void)state;
  static const char *const names[] = {"mesh", "buffer", "huge", "fifo"};
  for (int i = 0; i < 4; i++) unlink(in_folder(names[i]));
  return rmdir(folder);
}

/* The limits hold for a process until its end, so each check has one of its own. */
static void in_a_process(bool (*check)(abbe_mesh_files *files)) {
  fflush(NULL);
  const pid_t child = fork();
  if (child == 0) {
    abbe_mesh_files files;
    abbe_mesh_files_begin(&files);
    _exit(check(&files) ? 0 : 1);
  }
  int status = 0;
  assert_int_equal(waitpid(child, &status, 0), child);
  assert_true(WIFEXITED(status));
  assert_int_equal(WEXITSTATUS(status), 0);
}

static struct aiFile *open_one(abbe_mesh_files *files, const char *name) {
  return files->io.OpenProc(&files->io, in_folder(name), "rb");
}

static void close_one(abbe_mesh_files *files, struct aiFile *file) {
  files->io.CloseProc(&files->io, file);
}

static rlim_t limit(int which) {
  struct rlimit now;
  return getrlimit(which, &now) == 0 ? now.rlim_cur : 0;
}

static bool reads(abbe_mesh_files *files) {
  char text[8] = "";
  struct aiFile *f = open_one(files, "mesh");
  bool ok = f != NULL && f->FileSizeProc(f) == 4 && f->ReadProc(f, text, 1, 8) == 4 &&
            strcmp(text, "text") == 0 && f->TellProc(f) == 4;
  ok = ok && f->SeekProc(f, 1, aiOrigin_SET) == aiReturn_SUCCESS && f->TellProc(f) == 1;
  ok = ok && f->SeekProc(f, 1, aiOrigin_CUR) == aiReturn_SUCCESS && f->TellProc(f) == 2;
  ok = ok && f->SeekProc(f, 0, aiOrigin_END) == aiReturn_SUCCESS && f->TellProc(f) == 4;
  ok = ok && f->WriteProc(f, "x", 1, 1) == 0;
  close_one(files, f);
  return ok && files->io.OpenProc(&files->io, in_folder("new"), "wb") == NULL &&
         access(in_folder("new"), F_OK) != 0;
}

static bool refuses(abbe_mesh_files *files) {
  bool ok = open_one(files, "none") == NULL && files->error.text[0] == '\0';
  ok = ok && open_one(files, "fifo") == NULL;
  return ok && strstr(files->error.text, "fifo: is a named pipe") != NULL;
}

static bool counts(abbe_mesh_files *files) {
  const rlim_t memory = limit(RLIMIT_AS), seconds = limit(RLIMIT_CPU);
  const rlim_t size = 8 << 20;
  bool ok = seconds == ABBE_MESH_FILES_SECONDS && memory > ABBE_MESH_FILES_MEMORY;
  for (int i = 0; i < 3; i++) { /* as often as it is opened, it brings its room once */
    struct aiFile *f = open_one(files, "buffer");
    ok = ok && f != NULL;
    close_one(files, f);
    ok = ok && limit(RLIMIT_AS) == memory + ABBE_MESH_FILES_MEMORY_A_BYTE * size;
    ok = ok && limit(RLIMIT_CPU) == seconds + size / ABBE_MESH_FILES_BYTES_A_SECOND;
  }
  /* the first is the mesh itself */
  struct aiFile *f = open_one(files, "mesh");
  ok = ok && f != NULL && strcmp(files->others, in_folder("mesh")) == 0 &&
       files->others[files->used] == '\0';
  close_one(files, f);
  const unsigned left = alarm(0);
  return ok && left > 0 &&
         left <= ABBE_MESH_FILES_WALL + ABBE_MESH_FILES_WALL_A_SECOND * (seconds + 32);
}

static bool has_enough(abbe_mesh_files *files) {
  struct aiFile *f = open_one(files, "huge");
  bool ok = f != NULL;
  close_one(files, f);
  ok = ok && open_one(files, "buffer") == NULL;
  return ok && strstr(files->error.text, "buffer: the files of the mesh have") != NULL;
}

static void regular_files_are_read_and_none_is_written(void **state) {
  (void)state;
  in_a_process(reads);
}

static void a_pipe_is_refused_by_name(void **state) {
  (void)state;
  in_a_process(refuses);
}

static void each_file_brings_its_room_once(void **state) {
  (void)state;
  in_a_process(counts);
}

static void all_files_together_have_a_limit(void **state) {
  (void)state;
  in_a_process(has_enough);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(regular_files_are_read_and_none_is_written),
      cmocka_unit_test(a_pipe_is_refused_by_name),
      cmocka_unit_test(each_file_brings_its_room_once),
      cmocka_unit_test(all_files_together_have_a_limit),
  };
  return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
