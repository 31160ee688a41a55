!> Job scripts for queues: `implam queue slurm|pbs DECK`. A job ends before its limit with a checkpoint and exit code
!> 75; a chain of jobs continues until the run is complete; an array runs the decks of a sweep.
module queue_scripts
  use deck_contents, only: deck_t
  use deck_problems, only: problems_t
  use deck_reader, only: read_deck
  use errors, only: error_t, fail, exit_usage, exit_files
  use whole_files, only: write_new_file
  use kinds, only: wp
  use model_sizes, only: model_size_t, size_of_model
  use stepping_parameters, only: is_explicit
  use text, only: line_t, append, counted, to_text
  implicit none
  private
  public :: write_queue_script

  !> Ratio of requested to estimated memory: with adaptive layers an element takes up to 14900 bytes instead of 9700
  !> (`model_sizes`).
  real(wp), parameter :: spare_memory = 1.5_wp
  !> Wall-clock seconds of a job without `--time`, and largest reserve for the checkpoint.
  integer, parameter :: usual_seconds = 86400, max_kept = 600
  !> Largest number of parts of a chain, which ends one without progress.
  integer, parameter :: max_parts = 100

  !> Content of a script.
  type, public :: queue_job_t
    !> slurm or pbs
    character(len=:), allocatable :: queue
    !> Deck, or the list of commands (array.txt) of a sweep
    character(len=:), allocatable :: target
    !> The program as it was called
    character(len=:), allocatable :: program
    !> Ranks; 0: by the size of the deck
    integer :: ranks = 0
    !> Wall-clock seconds; 0: a day
    integer :: seconds = 0
    !> True: a job stopped by its limit is repeated until the run is complete
    logical :: chain = .false.
    !> Folder of the results; unallocated: that of the deck
    character(len=:), allocatable :: output
    !> Name of the job, and checkpoint of the run
    character(len=:), allocatable, private :: name, checkpoint
    !> Memory per rank
    integer, private :: megabytes = 0
    !> Lines of an array's list; 0: no array
    integer, private :: tasks = 0
  end type queue_job_t

contains

  !> Writes the script to the working directory, and gives instructions for it.
  subroutine write_queue_script(job, lines, error)
    !> Its content
    type(queue_job_t), intent(inout) :: job
    !> Instructions to print
    type(line_t), allocatable, intent(out) :: lines(:)
    !> Set if the deck or list has faults, or the script exists
    type(error_t), allocatable, intent(inout) :: error
    type(line_t), allocatable :: script(:)
    character(len=:), allocatable :: path

    allocate (lines(0))
    if (job%queue /= 'slurm' .and. job%queue /= 'pbs') then
      call fail(error, exit_usage, 'implam queue knows slurm and pbs.')
      return
    end if
    if (job%seconds == 0) job%seconds = usual_seconds
    if (len(job%target) > 4 .and. index(job%target, '.txt', back=.true.) == len(job%target) - 3) then
      call size_array(job, error)
    else
      call size_deck(job, error)
    end if
    if (allocated(job%output) .and. job%tasks > 0) call fail(error, exit_usage, &
      'The cases of a sweep have their own folders: give --output to implam-sweep and not to implam queue.')
    if (job%chain .and. job%tasks > 0 .and. job%queue == 'pbs') call fail(error, exit_usage, &
      'An array of PBS cannot be a chain; list the remaining runs with implam-sweep --array and submit that list.')
    if (allocated(error)) return
    allocate (script(0))
    if (job%queue == 'slurm') then
      call head_of_slurm(job, script)
    else
      call head_of_pbs(job, script)
    end if
    call append_body(job, script)
    path = job%name//'.'//job%queue
    call write_new_file(path, script, error)
    if (allocated(error)) return
    call append(lines, 'Wrote '//path//': '//counted(to_text(job%ranks), 'rank')// &
                ', '//to_text(job%megabytes)//' MB each, '//clock(job%seconds)//'.')
    call append(lines, 'To submit it: '//trim(merge('sbatch', 'qsub  ', job%queue == 'slurm'))//' '//path)
  end subroutine write_queue_script

  !> Name, results, ranks and memory of a deck.
  subroutine size_deck(job, error)
    type(queue_job_t), intent(inout) :: job
    !> Raised if the deck has faults
    type(error_t), allocatable, intent(inout) :: error
    type(deck_t) :: deck
    type(model_size_t) :: found

    call read_valid_deck(job%target, deck, error)
    if (allocated(error)) return
    found = size_of_model(deck%setup, is_explicit(deck%stepping))
    job%name = deck%case%name
    if (allocated(job%output)) deck%output%directory = job%output
    job%checkpoint = deck%output%directory//'/'//deck%case%name//'_restart.h5'
    if (job%ranks == 0) job%ranks = found%ranks
    job%megabytes = ceiling(spare_memory*found%megabytes_a_rank(job%ranks))
  end subroutine size_deck

  !> Number of commands of a sweep's list, and the largest of its decks, listed in decks.txt.
  subroutine size_array(job, error)
    type(queue_job_t), intent(inout) :: job
    !> Raised if a list cannot be read, is empty, or a deck has faults
    type(error_t), allocatable, intent(inout) :: error
    type(deck_t) :: deck
    type(model_size_t) :: found
    integer :: unit, status
    character(len=4096) :: path

    job%name = 'sweep'
    path = job%target(:index(job%target, '/', back=.true.))//'decks.txt'
    open (newunit=unit, file=trim(path), status='old', action='read', iostat=status)
    do while (status == 0)
      read (unit, '(a)', iostat=status) path
      if (status /= 0) exit
      job%tasks = job%tasks + 1
      call read_valid_deck(trim(path), deck, error)
      if (allocated(error)) exit
      found = size_of_model(deck%setup, is_explicit(deck%stepping))
      ! Ranks are those of `--program` of the sweep, by default one.
      if (job%ranks == 0) job%ranks = 1
      job%megabytes = max(job%megabytes, ceiling(spare_memory*found%megabytes_a_rank(job%ranks)))
    end do
    if (job%tasks > 0) close (unit)
    if (job%tasks == 0) call fail(error, exit_files, 'There is no decks.txt of implam-sweep --array beside '// &
                                  job%target//'.')
  end subroutine size_array

  !> Reads a deck that must have no faults.
  subroutine read_valid_deck(path, deck, error)
    character(len=*), intent(in) :: path
    type(deck_t), intent(out) :: deck
    !> Raised if it cannot be read or has faults
    type(error_t), allocatable, intent(inout) :: error
    type(problems_t) :: problems
    type(line_t), allocatable :: faults(:)

    call read_deck(path, deck, problems)
    if (problems%errors() == 0) return
    faults = problems%lines()
    if (problems%errors() > 1) faults(1)%text = faults(1)%text//' `implam check` lists all faults.'
    call fail(error, problems%exit_code(), faults(1)%text)
  end subroutine read_valid_deck

  !> Resources requested from Slurm. It may send the signal up to a minute early.
  subroutine head_of_slurm(job, script)
    type(queue_job_t), intent(in) :: job
    !> Lines are added
    type(line_t), allocatable, intent(inout) :: script(:)

    call append(script, '#!/bin/bash')
    call append(script, '#SBATCH --job-name='//job%name)
    call append(script, '#SBATCH --ntasks='//to_text(job%ranks)//' --cpus-per-task=1')
    call append(script, '#SBATCH --mem-per-cpu='//to_text(job%megabytes)//'M')
    call append(script, '#SBATCH --time='//clock(job%seconds))
    call append(script, '#SBATCH --signal=B:USR1@'//to_text(kept(job))//'  # to this shell, so many seconds ahead')
    if (job%tasks > 0) then
      call append(script, '#SBATCH --array=1-'//to_text(job%tasks)//' --output='//job%name// &
                  '.%A_%a.txt --open-mode=append')
    else
      call append(script, '#SBATCH --output='//job%name//'.%j.txt --open-mode=append')
    end if
    call append(script, '#SBATCH '//trim(merge('--requeue   ', '--no-requeue', job%chain)))
    call append(script, 'again() { scontrol requeue "$SLURM_JOB_ID"; }  # this shell is killed by it')
    call append(script, 'task=${SLURM_ARRAY_TASK_ID:-} parts=${SLURM_RESTART_COUNT:-0} in_time=()')
  end subroutine head_of_slurm

  !> Resources requested from PBS. It sends no signal before the limit; `timeout` in the script does.
  subroutine head_of_pbs(job, script)
    type(queue_job_t), intent(in) :: job
    !> Lines are added
    type(line_t), allocatable, intent(inout) :: script(:)

    call append(script, '#!/bin/bash')
    call append(script, '#PBS -N '//job%name(:min(15, len(job%name))))
    call append(script, '#PBS -l select=1:ncpus='//to_text(job%ranks)//':mpiprocs='//to_text(job%ranks)//':mem='// &
                to_text(job%ranks*job%megabytes)//'mb')
    call append(script, '#PBS -l walltime='//clock(job%seconds))
    if (job%tasks > 0) call append(script, '#PBS -J 1-'//to_text(job%tasks))
    call append(script, '#PBS -j oe')
    call append(script, '#PBS -r n')
    call append(script, 'if ! cd "$PBS_O_WORKDIR"; then exit 4; fi')
    call append(script, 'again() { qsub -v IMPLAM_PARTS=$((parts + 1)) '// &
                quoted(job%name//'.pbs')//'; }')
    call append(script, 'task=${PBS_ARRAY_INDEX:-} parts=${IMPLAM_PARTS:-0}')
    call append(script, 'in_time=(timeout --preserve-status --signal=USR1 '//to_text(job%seconds - kept(job))// &
                ')  # ahead of the limit')
  end subroutine head_of_pbs

  !> Commands for both queues.
  subroutine append_body(job, script)
    type(queue_job_t), intent(in) :: job
    !> Lines are added
    type(line_t), allocatable, intent(inout) :: script(:)
    character(len=:), allocatable :: launcher, run

    call append(script, '# Written by implam queue '//job%queue//' for '//job%target//'; the lines above may be '// &
                'changed.')
    call append(script, 'export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1')
    if (job%tasks > 0) then
      call append(script, 'command=(bash -c "exec $(sed -n "${task}p" '//quoted(job%target)//')")')
    else
      launcher = ''
      if (job%ranks > 1) launcher = 'mpirun -n '//to_text(job%ranks)//' '
      call append(script, 'command=('//launcher//'"${IMPLAM:-'//job%program//'}")')
      call append(script, '# A requeued job, or one submitted with the word restart, continues from a checkpoint.')
      call append(script, 'checkpoint='//quoted(job%checkpoint))
      call append(script, 'if [[ ${1:-} == restart ]]; then parts=1; fi')
      call append(script, 'if [[ -e $checkpoint && $parts -gt 0 ]]; then')
      call append(script, '  command+=(restart "$checkpoint")')
      call append(script, 'else')
      run = quoted(job%target)
      if (allocated(job%output)) run = run//' --output '//quoted(job%output)
      call append(script, '  command+=('//run//')')
      call append(script, 'fi')
    end if
    call append(script, 'signalled= run=')
    call append(script, 'stop() { signalled=yes; if [[ $run ]]; then kill -USR1 "$run"; fi; }')
    call append(script, 'trap stop USR1 TERM')
    call append(script, '"${in_time[@]}" "${command[@]}" & run=$!')
    call append(script, 'if [[ $signalled ]]; then kill -USR1 "$run"; fi')
    call append(script, 'wait "$run"; code=$?')
    call append(script, 'while [[ $signalled ]]; do signalled=; wait "$run"; code=$?; done  # signals end wait only')
    call append(script, 'if ((code == 138)); then code=75; fi  # stopped before the program could handle it')
    if (job%chain) then
      call append(script, 'if ((code == 75 && parts < '//to_text(max_parts)//')); then again; fi')
    else
      run = 'sbatch '//job%name//'.slurm restart'
      if (job%queue == 'pbs') run = 'qsub -v IMPLAM_PARTS=1 '//job%name//'.pbs'
      if (job%tasks > 0) run = 'the same script again'
      call append(script, 'if ((code == 75)); then echo "Stopped in time, with a checkpoint. To continue: '// &
                  run//'"; fi')
    end if
    call append(script, 'exit "$code"')
  end subroutine append_body

  !> Seconds before the limit that are reserved for the current step and the checkpoint.
  pure integer function kept(job)
    type(queue_job_t), intent(in) :: job

    kept = min(max_kept, job%seconds/2)
  end function kept

  !> Seconds as hours, minutes and seconds.
  pure function clock(seconds) result(words)
    !> The seconds
    integer, intent(in) :: seconds
    !> Such as 24:00:00
    character(len=:), allocatable :: words
    character(len=20) :: buffer

    write (buffer, '(i0,2(":",i2.2))') seconds/3600, mod(seconds, 3600)/60, mod(seconds, 60)
    words = trim(buffer)
  end function clock

  !> A word quoted for a shell.
  pure function quoted(word) result(safe)
    character(len=*), intent(in) :: word
    !> In quotes
    character(len=:), allocatable :: safe
    integer :: i

    safe = ''''
    do i = 1, len(word)
      if (word(i:i) == '''') then
        safe = safe//'''\'''''
      else
        safe = safe//word(i:i)
      end if
    end do
    safe = safe//''''
  end function quoted
end module queue_scripts
