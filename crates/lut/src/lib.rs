//! Checked axes, look-up tables with weights and gradients, polynomial surfaces; no word of aviation.
