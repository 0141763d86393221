// The benchmark's sections, each in a file of its own; the comment is its letter on the command line.
#pragma once
#include "bench/report.hpp"

namespace deburr::bench {

void implicit_against_embree(Report& report);      // a
void deburr_against_povray(Report& report);        // b
void rounded_against_sharp(Report& report);        // c
void growth_of_tracing(Report& report);            // d
void triage_against_flying_edges(Report& report);  // e
void growth_of_triage(Report& report);             // f
void one_thread_and_two(Report& report);           // g
void work_per_pixel(Report& report);               // h
void octree_against_every_voxel(Report& report);   // i
void embree_against_boxes(Report& report);         // j

}  // namespace deburr::bench
