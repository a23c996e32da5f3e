/* The slide by CVODE's BDF: cvode MILLISECONDS RELATIVE ABSOLUTE PROPORTION
 * prints the least run time (s) and then the drive force (N) at every millisecond. */
#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <stdio.h>
#include <stdlib.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <time.h>

enum { EQUATIONS = 13, W = 3, VELOCITY = 7, V_Z = 9 };

void slide_rates(double t, const double *state, double *into);
double slide_drive_force(double t, double v_z);

static int rates(realtype t, N_Vector y, N_Vector dy, void *unused) {
  (void)unused;
  slide_rates(t, N_VGetArrayPointer(y), N_VGetArrayPointer(dy));
  return 0;
}

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return t.tv_sec + 1e-9 * t.tv_nsec;
}

static void at_rest(N_Vector y) {
  N_VConst(0.0, y);
  NV_Ith_S(y, W) = 1.0;
}

int main(int count, char **arguments) {
  if (count != 5) return 2;
  int milliseconds = atoi(arguments[1]);
  double relative = atof(arguments[2]), absolute = atof(arguments[3]), proportion = atof(arguments[4]);
  SUNContext context;
  if (SUNContext_Create(NULL, &context)) return 1;
  N_Vector y = N_VNew_Serial(EQUATIONS, context), tolerances = N_VNew_Serial(EQUATIONS, context);
  for (int i = 0; i < EQUATIONS; i++) NV_Ith_S(tolerances, i) = i < VELOCITY ? absolute * proportion : absolute;
  at_rest(y);
  SUNMatrix matrix = SUNDenseMatrix(EQUATIONS, EQUATIONS, context);
  void *solver = CVodeCreate(CV_BDF, context);
  if (CVodeInit(solver, rates, 0.0, y) || CVodeSVtolerances(solver, relative, tolerances) ||
      CVodeSetLinearSolver(solver, SUNLinSol_Dense(y, matrix, context), matrix) ||
      CVodeSetMaxNumSteps(solver, 1000000) || CVodeSetErrFile(solver, NULL))
    return 1;

  double *force = malloc((milliseconds + 1) * sizeof *force);
  double least = 1e9, begin = now();
  for (int runs = 0; now() - begin < 0.5 && (runs < 5 || now() - begin < 0.03); runs++) {
    double start = now();
    at_rest(y);
    if (CVodeReInit(solver, 0.0, y)) return 1;
    force[0] = slide_drive_force(0.0, 0.0);
    for (int i = 1; i <= milliseconds; i++) {
      realtype t;
      if (CVode(solver, i * 1e-3, y, &t, CV_NORMAL) < 0) return 1;
      force[i] = slide_drive_force(t, NV_Ith_S(y, V_Z));
    }
    double time = now() - start;
    if (time < least) least = time;
  }
  printf("%.9g\n", least);
  for (int i = 0; i <= milliseconds; i++) printf("%.17g\n", force[i]);
  return 0;
}
