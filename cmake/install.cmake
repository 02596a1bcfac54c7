# the install step
