"""What compares with one document: its tables beside the computed values, its studies, its pages.

One folder a document. A machine of the catalogue, or its paper, names what is here as data
(`strutwork.machines.paper_reference`); nothing on a lower floor imports it.
"""
