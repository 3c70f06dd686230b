#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <type_traits>

#include "sim/render/offscreen_context.hpp"

namespace understory {

// From the OpenGL 2.0 specification: the headers are not needed for so few.
enum : unsigned {
  gl_float = 0x1406,
  gl_unsigned_int = 0x1405,
  gl_unsigned_byte_type = 0x1401,
  gl_triangles = 0x0004,
  gl_array_buffer = 0x8892,
  gl_element_array_buffer = 0x8893,
  gl_static_draw = 0x88E4,
  gl_vertex_shader = 0x8B31,
  gl_fragment_shader = 0x8B30,
  gl_compile_status = 0x8B81,
  gl_link_status = 0x8B82,
  gl_texture_2d = 0x0DE1,
  gl_texture0 = 0x84C0,
  gl_rgba_format = 0x1908,
  gl_nearest = 0x2600,
  gl_linear = 0x2601,
  gl_nearest_mipmap = 0x2700,
  gl_linear_mipmap = 0x2701,
  gl_min_filter = 0x2801,
  gl_mag_filter = 0x2800,
  gl_all_attrib_bits = 0xFFFFF,
  gl_client_all = 0xFFFFFFFF,
  gl_depth_test = 0x0B71,
  gl_cull_face = 0x0B44,
  gl_blend = 0x0BE2,
  gl_scissor_test = 0x0C11,
  gl_clip_plane0 = 0x3000,
  gl_lequal = 0x0203,
  gl_color_bit = 0x4000,
  gl_depth_bit = 0x0100,
  gl_unpack = 0x0CF5
};

/// The few functions that are needed, looked up once.
struct Gl {
  explicit Gl(const OffscreenContext& context) {
    const auto find = [&](auto& function, const char* name) {
      function = as_function<std::remove_reference_t<decltype(function)>>(context.function(name));
      if (function == nullptr) throw std::runtime_error(std::string("this OpenGL has no ") + name);
    };
    find(CreateShader, "glCreateShader"), find(ShaderSource, "glShaderSource"),
        find(CompileShader, "glCompileShader");
    find(GetShaderiv, "glGetShaderiv"), find(CreateProgram, "glCreateProgram"),
        find(AttachShader, "glAttachShader");
    find(BindAttribLocation, "glBindAttribLocation"), find(LinkProgram, "glLinkProgram"),
        find(GetProgramiv, "glGetProgramiv");
    find(UseProgram, "glUseProgram"), find(DeleteProgram, "glDeleteProgram"),
        find(DeleteShader, "glDeleteShader");
    find(GetUniformLocation, "glGetUniformLocation"), find(UniformMatrix4fv, "glUniformMatrix4fv");
    find(Uniform3f, "glUniform3f"), find(Uniform1f, "glUniform1f"), find(Uniform1i, "glUniform1i");
    find(GenBuffers, "glGenBuffers"), find(BindBuffer, "glBindBuffer"), find(BufferData, "glBufferData");
    find(BufferSubData, "glBufferSubData");
    find(DeleteBuffers, "glDeleteBuffers"), find(VertexAttribPointer, "glVertexAttribPointer");
    find(EnableVertexAttribArray, "glEnableVertexAttribArray"),
        find(DisableVertexAttribArray, "glDisableVertexAttribArray");
    find(MultiDrawElements, "glMultiDrawElements"), find(ActiveTexture, "glActiveTexture");
    find(GenTextures, "glGenTextures"), find(BindTexture, "glBindTexture"), find(TexImage2D, "glTexImage2D");
    find(TexParameteri, "glTexParameteri"), find(DeleteTextures, "glDeleteTextures"),
        find(PixelStorei, "glPixelStorei");
    find(Enable, "glEnable"), find(Disable, "glDisable"), find(DepthFunc, "glDepthFunc"),
        find(DepthMask, "glDepthMask");
    find(DepthRange, "glDepthRange"), find(ColorMask, "glColorMask"), find(Viewport, "glViewport"),
        find(Clear, "glClear");
    find(ClearColor, "glClearColor"), find(PushAttrib, "glPushAttrib"), find(PopAttrib, "glPopAttrib");
    find(PushClientAttrib, "glPushClientAttrib"), find(PopClientAttrib, "glPopClientAttrib");
  }
  unsigned (*CreateShader)(unsigned);
  void (*ShaderSource)(unsigned, int, const char* const*, const int*);
  void (*CompileShader)(unsigned);
  void (*GetShaderiv)(unsigned, unsigned, int*);
  unsigned (*CreateProgram)();
  void (*AttachShader)(unsigned, unsigned);
  void (*BindAttribLocation)(unsigned, unsigned, const char*);
  void (*LinkProgram)(unsigned);
  void (*GetProgramiv)(unsigned, unsigned, int*);
  void (*UseProgram)(unsigned);
  void (*DeleteProgram)(unsigned);
  void (*DeleteShader)(unsigned);
  int (*GetUniformLocation)(unsigned, const char*);
  void (*UniformMatrix4fv)(int, int, unsigned char, const float*);
  void (*Uniform3f)(int, float, float, float);
  void (*Uniform1f)(int, float);
  void (*Uniform1i)(int, int);
  void (*GenBuffers)(int, unsigned*);
  void (*BindBuffer)(unsigned, unsigned);
  void (*BufferData)(unsigned, std::ptrdiff_t, const void*, unsigned);
  void (*BufferSubData)(unsigned, std::ptrdiff_t, std::ptrdiff_t, const void*);
  void (*DeleteBuffers)(int, const unsigned*);
  void (*VertexAttribPointer)(unsigned, int, unsigned, unsigned char, int, const void*);
  void (*EnableVertexAttribArray)(unsigned);
  void (*DisableVertexAttribArray)(unsigned);
  void (*MultiDrawElements)(unsigned, const int*, unsigned, const void* const*, int);
  void (*ActiveTexture)(unsigned);
  void (*GenTextures)(int, unsigned*);
  void (*BindTexture)(unsigned, unsigned);
  void (*TexImage2D)(unsigned, int, int, int, int, int, unsigned, unsigned, const void*);
  void (*TexParameteri)(unsigned, unsigned, int);
  void (*DeleteTextures)(int, const unsigned*);
  void (*PixelStorei)(unsigned, int);
  void (*Enable)(unsigned);
  void (*Disable)(unsigned);
  void (*DepthFunc)(unsigned);
  void (*DepthMask)(unsigned char);
  void (*DepthRange)(double, double);
  void (*ColorMask)(unsigned char, unsigned char, unsigned char, unsigned char);
  void (*Viewport)(int, int, int, int);
  void (*Clear)(unsigned);
  void (*ClearColor)(float, float, float, float);
  void (*PushAttrib)(unsigned);
  void (*PopAttrib)();
  void (*PushClientAttrib)(unsigned);
  void (*PopClientAttrib)();
};

}  // namespace understory
