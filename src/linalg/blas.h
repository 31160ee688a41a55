/* The procedures of BLAS and LAPACK that C calls. */
#ifndef IMPLAM_BLAS_H
#define IMPLAM_BLAS_H

void dgemm_(const char *, const char *, const int *, const int *, const int *, const double *, const double *,
            const int *, const double *, const int *, const double *, double *, const int *);
void dpotrf_(const char *, const int *, double *, const int *, int *);
void dtrsm_(const char *, const char *, const char *, const char *, const int *, const int *, const double *,
            const double *, const int *, double *, const int *);

#endif
