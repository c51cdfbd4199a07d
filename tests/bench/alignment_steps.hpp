// Input and output of both sides of the alignment benchmark; plain C, as cloud_steps.hpp.
#pragma once

extern "C" {

// Points are interleaved x, y, z.
struct AlignmentTask {
  const float* source;   // source points, which move
  const float* normals;  // their normals
  int source_count;
  const float* target;
  int target_count;
  float reach_m;  // largest distance of a pair
};

struct AlignmentAnswer {
  double seconds;
  double matrix[12];  // T_target_source, row-major, without the last row
};

using RunAlignment = void (*)(const AlignmentTask& task, AlignmentAnswer& answer);
}
