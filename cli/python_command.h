/* python_command.h: a command that is a part of the Python module abbe: abbe.NAME, run by python3.
 * Internal to cli/.
 */
#ifndef ABBE_CLI_PYTHON_COMMAND_H
#define ABBE_CLI_PYTHON_COMMAND_H

/* Becomes Python with argc words of argv, and returns an exit code where it cannot. The module is
 * looked for beside the program; $ABBE_PYTHON is taken before Debian's own python3. */
int abbe_python_command_run(const char *name, int argc, char **argv);

#endif
