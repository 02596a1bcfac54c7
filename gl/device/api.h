/* api.h: the OpenGL 4.5 functions that Abbe calls, loaded through a context's own look-up.
 *
 * No global state: the table belongs to its context and is passed along. Only what is used is
 * listed; a missing function is an error that names it.
 */
#ifndef ABBE_GL_DEVICE_API_H
#define ABBE_GL_DEVICE_API_H

#include "base/error.h"

#include <GL/glcorearb.h>

/* X(pointer type's middle, name without gl) */
#define ABBE_GL_FUNCTIONS(X)                                                                                                     \
  X(ACTIVETEXTURE, ActiveTexture)                                                                                                \
  X(BEGINQUERY, BeginQuery)                                                                                                      \
  X(DELETEQUERIES, DeleteQueries)                                                                                                \
  X(ENDQUERY, EndQuery)                                                                                                          \
  X(GENQUERIES, GenQueries)                                                                                                      \
  X(GETQUERYOBJECTUIV, GetQueryObjectuiv)                                                                                        \
  X(COPYBUFFERSUBDATA, CopyBufferSubData)                                                                                        \
  X(ATTACHSHADER, AttachShader)                                                                                                  \
  X(COPYIMAGESUBDATA, CopyImageSubData) X(BINDBUFFER, BindBuffer) X(                                                             \
      BINDBUFFERBASE, BindBufferBase) X(BINDFRAMEBUFFER,                                                                         \
                                        BindFramebuffer) X(BINDIMAGETEXTURE,                                                     \
                                                           BindImageTexture) X(BINDSAMPLERS,                                     \
                                                                               BindSamplers)                                     \
      X(BINDTEXTURE, BindTexture) X(BINDVERTEXARRAY, BindVertexArray) X(                                                         \
          BLENDEQUATION, BlendEquation) X(BLITFRAMEBUFFER,                                                                       \
                                          BlitFramebuffer) X(BLENDFUNC, BlendFunc) X(BUFFERDATA,                                 \
                                                                                     BufferData)                                 \
          X(CLEARBUFFERSUBDATA, ClearBufferSubData) X(CLIPCONTROL, ClipControl) X(                                               \
              GETSTRINGI, GetStringi) X(COLORMASK, ColorMask) X(DEPTHRANGE, DepthRange) X(FLUSH,                                 \
                                                                                          Flush)                                 \
              X(GETBUFFERPARAMETERIV, GetBufferParameteriv) X(MAPBUFFERRANGE, MapBufferRange) X(                                 \
                  UNMAPBUFFER, UnmapBuffer) X(FRONTFACE, FrontFace) X(HINT, Hint) X(POLYGONMODE,                                 \
                                                                                    PolygonMode)                                 \
                  X(PROVOKINGVERTEX, ProvokingVertex) X(TEXSUBIMAGE2D, TexSubImage2D) X(                                         \
                      TEXTUREVIEW,                                                                                               \
                      TextureView) X(BUFFERSUBDATA,                                                                              \
                                     BufferSubData) X(CHECKFRAMEBUFFERSTATUS,                                                    \
                                                      CheckFramebufferStatus) X(CLEARBUFFERFV,                                   \
                                                                                ClearBufferfv)                                   \
                      X(CLEARBUFFERUIV, ClearBufferuiv) X(CLEARBUFFERDATA, ClearBufferData) X(                                   \
                          COMPILESHADER,                                                                                         \
                          CompileShader) X(CREATEPROGRAM,                                                                        \
                                           CreateProgram) X(CREATESHADER, CreateShader)                                          \
                          X(CULLFACE, CullFace) X(DELETEBUFFERS, DeleteBuffers) X(DELETEFRAMEBUFFERS, DeleteFramebuffers) X(     \
                              DELETEPROGRAM,                                                                                     \
                              DeleteProgram) X(DELETESHADER,                                                                     \
                                               DeleteShader) X(DELETETEXTURES, DeleteTextures)                                   \
                              X(DELETEVERTEXARRAYS, DeleteVertexArrays) X(DEPTHFUNC, DepthFunc) X(DEPTHMASK, DepthMask) X(       \
                                  DISABLE,                                                                                       \
                                  Disable) X(DISPATCHCOMPUTE,                                                                    \
                                             DispatchCompute) X(DISPATCHCOMPUTEINDIRECT, DispatchComputeIndirect)                \
                                  X(DRAWARRAYS, DrawArrays) X(DRAWARRAYSINDIRECT, DrawArraysIndirect) X(                         \
                                      DRAWBUFFERS,                                                                               \
                                      DrawBuffers) X(DRAWELEMENTS,                                                               \
                                                     DrawElements) X(ENABLE,                                                     \
                                                                     Enable) X(ENABLEVERTEXATTRIBARRAY, EnableVertexAttribArray) \
                                      X(FINISH, Finish) X(                                                                       \
                                          FRAMEBUFFERTEXTURE,                                                                    \
                                          FramebufferTexture) X(FRAMEBUFFERTEXTURELAYER, FramebufferTextureLayer)                \
                                          X(GENBUFFERS, GenBuffers) X(GENFRAMEBUFFERS, GenFramebuffers) X(                       \
                                              GENTEXTURES,                                                                       \
                                              GenTextures) X(GENVERTEXARRAYS,                                                    \
                                                             GenVertexArrays) X(GETBUFFERSUBDATA, GetBufferSubData)              \
                                              X(GETERROR, GetError) X(GETINTEGERV, GetIntegerv) X(GETPROGRAMIV, GetProgramiv) X( \
                                                  GETPROGRAMINFOLOG,                                                             \
                                                  GetProgramInfoLog) X(GETSHADERIV, GetShaderiv)                                 \
                                                  X(GETSHADERINFOLOG, GetShaderInfoLog) X(                                       \
                                                      GETSTRING,                                                                 \
                                                      GetString) X(GETTEXIMAGE, GetTexImage)                                     \
                                                      X(GETUNIFORMLOCATION, GetUniformLocation) X(                               \
                                                          LINKPROGRAM,                                                           \
                                                          LinkProgram) X(MEMORYBARRIER,                                          \
                                                                         MemoryBarrier) X(PIXELSTOREI, PixelStorei)              \
                                                          X(SHADERSOURCE, ShaderSource) X(                                       \
                                                              TEXBUFFER,                                                         \
                                                              TexBuffer) X(TEXPARAMETERI,                                        \
                                                                           TexParameteri)                                        \
                                                              X(TEXSTORAGE2D, TexStorage2D) X(                                   \
                                                                  TEXSTORAGE3D,                                                  \
                                                                  TexStorage3D) X(TEXSUBIMAGE3D, TexSubImage3D)                  \
                                                                  X(UNIFORM1F,                                                   \
                                                                    Uniform1f) X(UNIFORM1FV,                                     \
                                                                                 Uniform1fv) X(UNIFORM1I,                        \
                                                                                               Uniform1i)                        \
                                                                      X(UNIFORM1UI, Uniform1ui) X(                               \
                                                                          UNIFORM2I,                                             \
                                                                          Uniform2i) X(UNIFORM2F,                                \
                                                                                       Uniform2f)                                \
                                                                          X(UNIFORM3FV, Uniform3fv) X(                           \
                                                                              UNIFORM3F,                                         \
                                                                              Uniform3f) X(UNIFORM4F,                            \
                                                                                           Uniform4f)                            \
                                                                              X(UNIFORM4FV, Uniform4fv) X(                       \
                                                                                  UNIFORMMATRIX3FV,                              \
                                                                                  UniformMatrix3fv)                              \
                                                                                  X(SCISSOR,                                     \
                                                                                    Scissor) X(UNIFORMMATRIX4FV,                 \
                                                                                               UniformMatrix4fv)                 \
                                                                                      X(USEPROGRAM,                              \
                                                                                        UseProgram)                              \
                                                                                          X(VERTEXATTRIBPOINTER,                 \
                                                                                            VertexAttribPointer)                 \
                                                                                              X(VIEWPORT,                        \
                                                                                                Viewport)

typedef struct abbe_gl {
#define ABBE_GL_FIELD(type, name) PFNGL##type##PROC name;
  ABBE_GL_FUNCTIONS(ABBE_GL_FIELD)
#undef ABBE_GL_FIELD
  const char *description; /* the context's, for messages; NULL: not known */
} abbe_gl;

typedef void (*abbe_gl_function)(void);
typedef abbe_gl_function (*abbe_gl_lookup)(const char *name);

/* Fills the table by the context's look-up, as far as it has the functions. ABBE_GL names the first
 * that is missing. */
abbe_result abbe_gl_load(abbe_gl_lookup lookup, abbe_gl *out, abbe_error *error);

/* Clears the errors that the context holds: one flag a kind, of which there are eight; a lost
 * context has no end of them. */
void abbe_gl_clear_errors(const abbe_gl *gl);

/* ABBE_GL with `where` and the error's name if the context holds an error; clears it. Of a lost
 * device it names the driver. */
abbe_result abbe_gl_check(const abbe_gl *gl, const char *where, abbe_error *error);

/* OpenGL's state around Abbe's passes: what they rely on, whatever a caller left, and what
 * a caller finds afterwards (gl/renderer.h says it). It touches no texture binding, no indexed
 * buffer, no viewport. */

/* Units from 0 on whose sampler objects are taken away: a sampler would override what a texture
 * says of its own filter. No pass uses further units (bindings.h). */
#define ABBE_GL_STATE_UNITS 18

/* Sets, in the current context, every enable and every setting of rasterising, testing, blending
 * and pixel transfer as GL begins with it, but rows of pixels without padding and cube maps read
 * across their edges; no sampler objects and no pixel buffers. Errors that are pending are
 * dropped. */
void abbe_gl_state_begin(const abbe_gl *gl);

/* GL's own settings once more, rows of pixels padded to 4 bytes; framebuffer 0, no program, no
 * vertex array, texture unit 0 active. */
void abbe_gl_state_end(const abbe_gl *gl);

#endif
