# cmake -DMODULES=folder -DSTAMP=file -P module_stamp.cmake: writes the digests of the folder's modules to the stamp, unless
# it has them already. Ninja then does not rebuild what depends on an unchanged stamp.
file(GLOB modules ${MODULES}/*.mod)
list(SORT modules)
set(digests "")
foreach(module IN LISTS modules)
  file(SHA256 ${module} digest)
  get_filename_component(name ${module} NAME)
  string(APPEND digests "${digest}  ${name}\n")
endforeach()
file(CONFIGURE OUTPUT ${STAMP} CONTENT "${digests}" @ONLY)
