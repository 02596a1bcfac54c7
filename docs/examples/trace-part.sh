#!/bin/sh
# A part of a trace for each task: sbatch --array=0-3 trace-part.sh
#SBATCH --cpus-per-task=16
k=$SLURM_ARRAY_TASK_ID
exec abbe trace scenes/gem.yaml -o gem.exr --size 64x64 --photons 20000 --spp 16 \
  --passes $((4 * k)):$((4 * k + 4)) --checkpoint part-$k.ck --resume --quiet
