/* OpenBLAS chooses its kernels by the name of the processor as it is loaded; for a processor newer than itself it takes
   those of 2004, which factor at half the speed or less. What instructions the processor has is known here, so the
   choice is made once more, by the library's own procedure and its own variable of the environment. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdlib.h>
#include <string.h>

/* The newest kernels that this processor can run, or nothing where the library's own choice is as good. */
static const char *better_kernels(const char *chosen)
{
#if defined(__x86_64__) && defined(__GNUC__)
  const char *const dated[] = {"Prescott", "Core2", "Penryn", "Dunnington", "Nehalem", "Atom", "Opteron", "Barcelona"};
  unsigned i = 0;
  while (i < sizeof dated / sizeof dated[0] && strcmp(chosen, dated[i]) != 0) ++i;
  if (i == sizeof dated / sizeof dated[0]) return 0;
  if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma")) return 0;
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") &&
      __builtin_cpu_supports("avx512vl"))
    return "SkylakeX";
  return "Haswell";
#else
  (void)chosen;
  return 0;
#endif
}

/* Lets OpenBLAS choose again. Another library, or a choice of the user's, is left as it is. */
void implam_choose_blas_kernels(void)
{
  char *(*name)(void) = (char *(*)(void))dlsym(RTLD_DEFAULT, "openblas_get_corename");
  void (*leave)(void) = (void (*)(void))dlsym(RTLD_DEFAULT, "gotoblas_dynamic_quit");
  void (*choose)(void) = (void (*)(void))dlsym(RTLD_DEFAULT, "gotoblas_dynamic_init");
  if (!name || !leave || !choose || getenv("OPENBLAS_CORETYPE")) return;
  const char *better = better_kernels(name());
  if (!better) return;
  setenv("OPENBLAS_CORETYPE", better, 1);
  leave();
  choose();
}
