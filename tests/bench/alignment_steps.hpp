// What both sides of the alignment race are told, and what they give back; plain C, as
// cloud_steps.hpp.
#pragma once

extern "C" {

// Points as x, y, z side by side.
struct AlignmentTask {
  const float* source;   // that moves ..
  const float* normals;  // .. with its normals
  int source_count;
  const float* target;
  int target_count;
  float reach_m;  // as far as points are paired at most
};

struct AlignmentAnswer {
  double seconds;
  double matrix[12];  // target from source, row by row, without the last
};

using RunAlignment = void (*)(const AlignmentTask& task, AlignmentAnswer& answer);
}
