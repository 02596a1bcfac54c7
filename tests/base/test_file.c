#define _XOPEN_SOURCE 700
#include "tests/check.h"

#include "base/file.h"

#include <dirent.h>
#include <poll.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

static char folder[256];

static const char *in_folder(const char *name) {
  static char path[2][1024];
  static int turn;
  turn = !turn;
  snprintf(path[turn], sizeof path[turn], "%s/%s", folder, name);
  return path[turn];
}

static void make_folder(void) {
  snprintf(folder, sizeof folder, "/tmp/abbe-test-file-XXXXXX");
  assert_non_null(mkdtemp(folder));
}

static int entries(void) {
  DIR *dir = opendir(folder);
  assert_non_null(dir);
  int count = 0;
  for (struct dirent *entry; (entry = readdir(dir)) != NULL;)
    count += strcmp(entry->d_name, ".") && strcmp(entry->d_name, "..");
  closedir(dir);
  return count;
}

static void empty_folder(void) {
  DIR *dir = opendir(folder);
  for (struct dirent *entry; (entry = readdir(dir)) != NULL;)
    if (strcmp(entry->d_name, ".") && strcmp(entry->d_name, "..")) remove(in_folder(entry->d_name));
  closedir(dir);
  assert_false(rmdir(folder));
}

static void assert_holds(const char *path, const char *text) {
  FREED char *data = NULL;
  size_t size = 0;
  OK(abbe_file_read(path, 1000, &data, &size, &error));
  assert_int_equal(size, strlen(text));
  assert_string_equal(data, text);
}

GROUP(make_folder, empty_folder);

TEST(what_is_written_is_read) {
  FREED char *data = NULL;
  size_t size = 0;
  OK(abbe_file_write(in_folder("a"), "x\0y", 3, &error));
  OK(abbe_file_read(in_folder("a"), 3, &data, &size, &error));
  assert_int_equal(size, 3);
  assert_memory_equal(data, "x\0y", 4);
  OK(abbe_file_write(in_folder("a"), "", 0, &error));
  assert_holds(in_folder("a"), "");
  assert_int_equal(entries(), 1);
}

TEST(what_cannot_be_read_says_why) {
  char *data = NULL;
  size_t size = 0;
  REFUSED(ABBE_IO, "/none: ", abbe_file_read(in_folder("none"), 10, &data, &size, &error));
  REFUSED(ABBE_IO, "is a directory", abbe_file_read(folder, 10, &data, &size, &error));
  OK(abbe_file_write(in_folder("long"), "12345678901", 11, &error));
  REFUSED(ABBE_IO, "at most 10", abbe_file_read(in_folder("long"), 10, &data, &size, &error));
  assert_null(data);
}

/* Whoever waits at one of these is ended by the test's limit alone. */
TEST(only_a_regular_file_is_opened) {
  char *data = NULL;
  size_t size = 0;
  FILE *stream = NULL;
  const struct {
    const char *path, *kind;
  } others[] = {{in_folder("fifo"), "is a named pipe"},
                {"/dev/zero", "is a device"},
                {folder, "is a directory"}};
  assert_int_equal(mkfifo(others[0].path, 0600), 0);
  for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
    REFUSED(ABBE_IO, others[i].path, abbe_file_read(others[i].path, 100000, &data, &size, &error));
    assert_contains(last_error.text, others[i].kind);
    REFUSED(ABBE_IO, others[i].kind, abbe_file_open(others[i].path, &stream, &size, &error));
    assert_null(stream);
  }
  assert_null(data);
  OK(abbe_file_write(in_folder("whole"), "12345", 5, &error));
  OK(abbe_file_open(in_folder("whole"), &stream, &size, &error));
  assert_int_equal(size, 5);
  assert_int_equal(fgetc(stream), '1');
  fclose(stream);
}

/* The poll that abbe_file_read calls (tests/spectral.cmake): time that passes without a byte. */
static bool nothing_comes;
int __real_poll(struct pollfd *one, nfds_t count, int milliseconds);
int __wrap_poll(struct pollfd *one, nfds_t count, int milliseconds);
int __wrap_poll(struct pollfd *one, nfds_t count, int milliseconds) {
  if (!nothing_comes) return __real_poll(one, count, milliseconds);
  assert_int_equal(milliseconds, 1000 * ABBE_FILE_PATIENCE_SECONDS);
  return 0;
}

/* As a shell's <(...) is one. */
TEST(a_nameless_pipe_is_read_while_it_brings_something) {
  int end[2];
  char *data = NULL;
  size_t size = 0;
  assert_int_equal(pipe(end), 0);
  const char *path = printed("/dev/fd/%d", end[0]);
  assert_int_equal(write(end[1], "text", 4), 4);
  nothing_comes = true;
  REFUSED(ABBE_IO, "", abbe_file_read(path, 100, &data, &size, &error));
  nothing_comes = false;
  assert_contains(last_error.text, "nothing has come through this pipe for 60 s");
  assert_null(data);
  assert_int_equal(write(end[1], "more", 4), 4);
  close(end[1]);
  assert_holds(path, "more");
  close(end[0]);
}

TEST(standard_input_is_read) {
  int end[2], kept = dup(STDIN_FILENO);
  FREED char *data = NULL;
  size_t size = 0;
  assert_int_equal(pipe(end), 0);
  assert_int_equal(write(end[1], "text", 4), 4);
  close(end[1]);
  dup2(end[0], STDIN_FILENO);
  OK(abbe_file_read_input(100, &data, &size, &error));
  dup2(kept, STDIN_FILENO);
  close(kept);
  close(end[0]);
  assert_string_equal(data, "text");
}

TEST(a_file_without_a_size_is_read) {
  FREED char *data = NULL;
  size_t size = 0;
  OK(abbe_file_read("/proc/self/status", 1 << 20, &data, &size, &error));
  assert_contains(data, "Name:");
  assert_int_equal(size, strlen(data));
}

TEST(nothing_changes_before_commit_or_after_discard) {
  abbe_file_writer writer;
  OK(abbe_file_write(in_folder("t"), "old", 3, &error));
  int before = entries();
  OK(abbe_file_writer_open(&writer, in_folder("t"), &error));
  fputs("new", writer.stream);
  fflush(writer.stream);
  assert_holds(in_folder("t"), "old");
  assert_int_equal(entries(), before + (writer.temporary != NULL));
  abbe_file_writer_discard(&writer);
  assert_null(writer.stream);
  assert_holds(in_folder("t"), "old");
  assert_int_equal(entries(), before);
  abbe_file_writer_discard(&writer);
  assert_int_equal(abbe_file_writer_commit(&writer, NULL), ABBE_INVALID_ARGUMENT);
}

TEST(a_link_is_written_through_and_a_mode_is_kept) {
  struct stat status;
  OK(abbe_file_write(in_folder("target"), "old", 3, &error));
  assert_int_equal(chmod(in_folder("target"), 0640), 0);
  assert_int_equal(symlink("target", in_folder("link")), 0);
  OK(abbe_file_write(in_folder("link"), "new", 3, &error));
  assert_int_equal(lstat(in_folder("link"), &status), 0);
  assert_true(S_ISLNK(status.st_mode));
  assert_holds(in_folder("target"), "new");
  assert_int_equal(stat(in_folder("target"), &status), 0);
  assert_int_equal(status.st_mode & 0777, 0640);
  assert_int_equal(symlink("nowhere", in_folder("dangling")), 0);
  assert_int_equal(abbe_file_write(in_folder("dangling"), "new", 3, NULL), ABBE_IO);
}

TEST(an_unwritable_target_says_why) {
  int before = entries();
  REFUSED(ABBE_IO, "no/such/folder", abbe_file_write(in_folder("no/such/folder"), "x", 1, &error));
  REFUSED(ABBE_IO, "directory", abbe_file_write(folder, "x", 1, &error));
  REFUSED(ABBE_IO, "not a regular file", abbe_file_write("/dev/null", "x", 1, &error));
  REFUSED(ABBE_IO, "", abbe_file_write("", "x", 1, &error));
  assert_int_equal(entries(), before);
}

TEST(a_name_as_long_as_names_can_be_works) {
  char name[256];
  memset(name, 'n', 255);
  name[255] = '\0';
  OK(abbe_file_write(in_folder(name), "x", 1, &error));
  assert_holds(in_folder(name), "x");
}

/* A file-size limit fails a write as a full disk does. */
TEST(a_full_disk_leaves_the_old_file) {
  enum { SIZE = 1 << 20 };
  FREED char *big = calloc(1, SIZE);
  assert_non_null(big);
  OK(abbe_file_write(in_folder("kept"), "old", 3, &error));
  int before = entries();
  struct rlimit limit, small;
  assert_int_equal(getrlimit(RLIMIT_FSIZE, &limit), 0);
  small = limit;
  small.rlim_cur = 4096;
  signal(SIGXFSZ, SIG_IGN);
  assert_int_equal(setrlimit(RLIMIT_FSIZE, &small), 0);
  abbe_error why = {0};
  abbe_result result = abbe_file_write(in_folder("kept"), big, SIZE, &why);
  /* small enough for the stream's buffer: the failure shows at commit only */
  abbe_result buffered = abbe_file_write(in_folder("kept"), big, 4097, NULL);
  setrlimit(RLIMIT_FSIZE, &limit);
  assert_int_equal(result, ABBE_IO);
  assert_int_equal(buffered, ABBE_IO);
  assert_contains(why.text, "kept");
  assert_contains(why.text, "File too large");
  assert_holds(in_folder("kept"), "old");
  assert_int_equal(entries(), before);
}

TEST(name_follows_the_last_slash) {
  assert_string_equal(abbe_file_name("a/b.exr"), "b.exr");
  assert_string_equal(abbe_file_name("b.exr"), "b.exr");
  assert_string_equal(abbe_file_name("/"), "");
}
