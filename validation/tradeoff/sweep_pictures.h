/* sweep_pictures.h: the Pareto fronts of whole pictures off sweeps, one of each tool: what its
 * process takes from its start to its end, against its error.
 *
 * Of a class of scenes, over the settings that all its sweeps have with a whole process's time.
 * What a scene takes is measured by what is quick to measure anywhere, the yardstick: a frame of
 * the tracer with few photons. A point's time is the geometric mean of the yardstick's, times the
 * worst of the scenes' ratios to it. The tracer's errors are told likewise, by what the yardstick
 * says of its own error; the renderer's is the worst of the scenes'. It is a part of the file that
 * sweep_presets.h writes, and what library/choice/picture_choice.h reads.
 */
#ifndef ABBE_VALIDATION_TRADEOFF_SWEEP_PICTURES_H
#define ABBE_VALIDATION_TRADEOFF_SWEEP_PICTURES_H

#include "validation/tradeoff/sweep_table.h"

#include <stdio.h>

/* X(code, name, profile): the tools, and the contestants of a sweep that they are. */
#define ABBE_PICTURE_TOOLS(X)                                                                      \
  X(RENDER, "render", "default")                                                                   \
  X(TRACE, "trace", ABBE_SWEEP_TRACE)                                                              \
  X(TRACE_FILTER, "trace-filter", ABBE_SWEEP_TRACE_FILTER)
typedef enum abbe_picture_tool {
#define ABBE_PICTURE_ENUM(code, name, profile) ABBE_PICTURE_##code,
  ABBE_PICTURE_TOOLS(ABBE_PICTURE_ENUM)
#undef ABBE_PICTURE_ENUM
      ABBE_PICTURE_TOOL_COUNT
} abbe_picture_tool;
const char *abbe_picture_tool_name(abbe_picture_tool tool);
/* The tool whose setting that is, or ABBE_PICTURE_TOOL_COUNT. */
abbe_picture_tool abbe_picture_tool_of(const abbe_sweep_setting *setting);

#define ABBE_PICTURE_YARDSTICK_PASSES 2
#define ABBE_PICTURE_YARDSTICK_PHOTONS 128

/* Adds "  pictures:" of the class to a file of presets, over the tables of that class whose errors
 * are above their noise; nothing where one has no yardstick. A class with one scene takes the
 * widest margins of the other classes, tool by tool (1: no class has any). ABBE_NO_MEMORY. */
abbe_result abbe_sweep_pictures_write(FILE *out, const abbe_sweep_table *tables, size_t count,
                                      const char *of, abbe_sweep_number number, abbe_error *error);

#endif
